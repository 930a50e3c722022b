//! `racer pilot`: a policy flies a vehicle over a link, in real time.

mod rehearse;

use super::{CommandEnd, interrupt, tell};
use crate::base::check::BadInput;
use crate::base::fsio::Reserved;
use crate::flight::live::histogram::Histogram;
use crate::flight::live::pace::{self, Line, Timing, User};
use crate::flight::live::phase::{Phase, Reason};
use crate::flight::live::route::{Leg, Route, Wishes};
use crate::flight::live::{Live, Mission, port};
use crate::flight::write;
use crate::present::run;
use crate::race::onboard::Surroundings;
use crate::race::snapshot::Snapshot;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::mpsc::sync_channel;

/// Let a policy fly a vehicle: states in, setpoints out, in real time
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// A run folder (its best policy), a snapshot file, or `latest` for the youngest run below runs/
    #[arg(value_name = "RUN|SNAPSHOT|latest", required_unless_present = "excite")]
    policy: Option<String>,
    /// Where states come from: udp:PORT (racer's own packets), mavlink:LINK, or ros2:/NAMESPACE
    #[arg(long = "in", value_name = "SOURCE", required_unless_present = "rehearse")]
    input: Option<String>,
    /// Where setpoints go: udp:HOST:PORT, mavlink:LINK, msp:LINK, or ros2:/NAMESPACE [default: back to where they
    /// come from]
    #[arg(long = "out", value_name = "SINK")]
    output: Option<String>,
    /// The dead man's switch: offboard (armed, and in the mode that takes setpoints), rc:CHANNEL (held above 1700 us),
    /// or button:NUMBER [default: the bit in racer's own packets]
    #[arg(long)]
    switch: Option<String>,
    /// Over MSP: the channel that arms, 5 to 16, a second before the flight [default: the pilot arms]
    #[arg(long, value_name = "CHANNEL", value_parser = clap::value_parser!(u8).range(5..=16))]
    arm: Option<u8>,
    /// Laps to fly [default: until something else ends the flight]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    laps: Option<u32>,
    /// Longest time from the start of the program to the end of the flight, s
    #[arg(long, default_value_t = 600.0, allow_negative_numbers = true, value_parser = super::values::parse_seconds)]
    seconds: f64,
    /// New file for the log of the flight (MCAP), which `check` and `replay` read
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    #[command(flatten)]
    rehearsal: rehearse::Args,
}

const HELP: &str = "The policy is given the vehicle when a fresh state shows it at rest on the track's start pad and \
the dead man's switch is released once and then held. It hands back, for good, when the switch is released, at Ctrl-C, \
and on a stale or jumping estimate, a battery that is empty or untold, the fence of the flight volume, a missed gate, \
a broken link, or an observation outside of the training's for 0.2 s. A LINK is udp:PORT (answers go to who spoke), \
udp:HOST:PORT, tcp:HOST:PORT, or /dev/NAME[:BAUD]. docs/flying.md says what to set in the firmware, has the packets, \
and draws the states.

Examples:
  racer pilot latest --in udp:9101 --out udp:127.0.0.1:9102 --laps 3 --log flight.mcap
  racer pilot latest --in mavlink:udp:14540 --switch offboard --laps 3
  racer pilot latest --in udp:9101 --out msp:/dev/ttyACM0 --switch rc:8 --laps 3
  racer pilot latest --rehearse betaflight --firmware betaflight_SITL --laps 10 --log rehearsal.mcap
  racer pilot --rehearse betaflight --firmware betaflight_SITL --excite 120 --log excited.mcap
  racer pilot latest --rehearse ardupilot --firmware build/sitl/bin/arducopter --laps 10";

/// Periods that motors are given to arm and to spin up: a second.
const LEAD: u32 = 100;

/// Waits, flies, reports.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let policy = args.policy.as_deref().map(|policy| anyhow::Ok(Snapshot::read(&run::find(policy)?.snapshot)?));
    let Some(source) = args.input.as_deref() else {
        let Args { laps, seconds, ref log, .. } = *args;
        let asked = rehearse::Asked { policy: policy.transpose()?, laps, seconds, log: log.as_deref() };
        return rehearse::run(&args.rehearsal, asked);
    };
    let route = Route::of(&Wishes {
        source,
        sink: args.output.as_deref(),
        switch: args.switch.as_deref(),
        arm: args.arm.map(usize::from),
    })?;
    let Some(snapshot) = policy.transpose()? else { unreachable!("asked for by the arguments") };
    let file = args.log.as_deref().map(|path| Reserved::new(path, "--log")).transpose()?;
    let range = snapshot.ranges();
    let Snapshot { network, about } = snapshot;
    let lead = if args.arm.is_some() { LEAD } else { 0 };
    let mission = Mission { network, track: about.track, vehicle: about.vehicle, range, laps: args.laps, lead };
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let (to, arrived) = sync_channel(port::WAITING);
    let open = |(i, leg): (usize, Leg)| {
        let port = port::open(&leg.endpoint, &leg.option, i, &to)?;
        Ok(Line { protocol: leg.protocol, port })
    };
    let mut lines =
        route.legs(around.full_rate).into_iter().enumerate().map(open).collect::<Result<Vec<_>, BadInput>>()?;
    let mut live = Live::new(&mission, &around);
    interrupt::watch("handing back; Ctrl-C again ends at once");
    let sink = args.output.as_deref().unwrap_or("the same link");
    tell(&format!("{} in {}; states from {}, setpoints to {sink}", mission.track.name, mission.vehicle.name, source));
    let mut user = User { key: &interrupt::asked, told: &mut |phase, reason| tell(&phase_line(phase, reason)) };
    let timing = pace::fly(&mut live, &mut lines, &arrived, args.seconds, &mut user);
    super::print(&summary(&live, &timing))?;
    if let Some(file) = file {
        let written = file.write(&write::mcap(&live.record.log)?)?;
        tell(&format!("written to {}", written.display()));
    }
    Ok(CommandEnd::Done)
}

fn phase_line(phase: Phase, reason: Option<Reason>) -> String {
    let hint = if phase == Phase::Ready { ": hold the switch to fly" } else { "" };
    let reason = reason.map_or(String::new(), |reason| format!(": {}", reason.text()));
    format!("{}{hint}{reason}", phase.name())
}

/// The flight, the link, and how well real time was kept.
fn summary(live: &Live, timing: &Timing) -> String {
    let link = &live.link;
    let mut text = format!("gates      {} passed\n", live.gates);
    let _ = writeln!(
        text,
        "states     {}; {} messages lost, {} late or doubled, {} unusable, {} foreign",
        link.received, link.lost, link.late, link.unusable, link.foreign
    );
    for (name, histogram) in [("age", &live.ages), ("wake-up", &timing.wake), ("answer", &timing.answer)] {
        let _ = writeln!(text, "{name:<10} {}", line(histogram));
    }
    let _ = write!(text, "deadlines  {} missed of {}", timing.missed, timing.wake.count + timing.missed);
    text
}

fn line(histogram: &Histogram) -> String {
    let at = |share| histogram.quantile(share).map(|seconds| 1e3 * seconds);
    match (at(0.5), at(0.99), at(0.999)) {
        (Some(half), Some(most), Some(nearly)) => format!(
            "median {half:.3} ms, 99 % {most:.3} ms, 99.9 % {nearly:.3} ms, longest {:.3} ms",
            1e3 * histogram.longest_s
        ),
        _ => "none".into(),
    }
}
