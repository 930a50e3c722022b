//! `racer pilot`: a policy flies a vehicle over a link, in real time.

use super::{CommandEnd, interrupt, tell};
use crate::base::check::BadInput;
use crate::base::fsio::Reserved;
use crate::flight::live::histogram::Histogram;
use crate::flight::live::phase::{Phase, Reason};
use crate::flight::live::udp::{self, Timing};
use crate::flight::live::{Live, Mission};
use crate::flight::write;
use crate::present::run;
use crate::race::onboard::Surroundings;
use crate::race::snapshot::Snapshot;
use std::fmt::Write;
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::path::PathBuf;

/// Let a policy fly a vehicle: states in, setpoints out, in real time
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// A run folder (its best policy), a snapshot file, or `latest` for the youngest run below runs/
    #[arg(value_name = "RUN|SNAPSHOT|latest")]
    policy: String,
    /// Where states arrive
    #[arg(long = "in", value_name = "udp:PORT")]
    input: String,
    /// Where setpoints go
    #[arg(long = "out", value_name = "udp:HOST:PORT")]
    output: String,
    /// Laps to fly [default: until something else ends the flight]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    laps: Option<u32>,
    /// Longest time from the start of the program to the end of the flight, s
    #[arg(long, default_value_t = 600.0, allow_negative_numbers = true, value_parser = super::values::parse_seconds)]
    seconds: f64,
    /// New file for the log of the flight (MCAP), which `check` and `replay` read
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
}

const HELP: &str = "The policy is given the vehicle when a fresh state shows it at rest on the track's start pad and \
the dead man's switch in the packets is released once and then held. It hands back, for good, when the switch is \
released, at Ctrl-C, and on a stale or jumping estimate, an empty battery, the fence of the flight volume, a missed \
gate, or an observation outside of the training's for 0.2 s. docs/flying.md has the packets and draws the states.

Example:
  racer pilot latest --in udp:9101 --out udp:127.0.0.1:9102 --laps 3 --log flight.mcap";

/// Waits, flies, reports.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let snapshot = Snapshot::read(&run::find(&args.policy)?.snapshot)?;
    let port = parse_input(&args.input)?;
    let to = parse_output(&args.output)?;
    let file = args.log.as_deref().map(Reserved::new).transpose()?;
    let input = UdpSocket::bind(("0.0.0.0", port)).map_err(|error| {
        BadInput::new(format!("--in {}", args.input), error, "a port that is free", "choose another port")
    })?;
    let range = snapshot.ranges();
    let Snapshot { network, about } = snapshot;
    let mission = Mission { network, track: about.track, vehicle: about.vehicle, range, laps: args.laps };
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let mut live = Live::new(&mission, &around);
    interrupt::watch("handing back; Ctrl-C again ends at once");
    tell(&format!("{} in {}; states at port {port}, setpoints to {to}", mission.track.name, mission.vehicle.name));
    let mut told = |phase: Phase, reason: Option<Reason>| {
        tell(&format!("{}{}", name(phase), reason.map_or(String::new(), |r| format!(": {}", r.text()))));
    };
    let timing = udp::fly(&mut live, &input, to, args.seconds, &interrupt::asked, &mut told)?;
    super::print(&summary(&live, &timing))?;
    if let Some(file) = file {
        let written = file.write(&write::mcap(&live.record.log)?)?;
        tell(&format!("written to {}", written.display()));
    }
    Ok(CommandEnd::Done)
}

fn parse_input(text: &str) -> Result<u16, BadInput> {
    let port = text.strip_prefix("udp:").and_then(|port| port.parse().ok()).filter(|&port| port > 0);
    port.ok_or_else(|| BadInput::new("--in", text, "udp:PORT, such as udp:9101", ""))
}

fn parse_output(text: &str) -> Result<SocketAddr, BadInput> {
    let refuse = |why: String| BadInput::new("--out", why, "udp:HOST:PORT, such as udp:127.0.0.1:9102", "");
    let place = text.strip_prefix("udp:").ok_or_else(|| refuse(text.into()))?;
    let found = place.to_socket_addrs().map_err(|error| refuse(format!("{text}: {error}")))?.next();
    found.ok_or_else(|| refuse(format!("{text}, which names no address")))
}

fn name(phase: Phase) -> &'static str {
    match phase {
        Phase::Waiting => "waiting",
        Phase::Ready => "ready: hold the switch to fly",
        Phase::Flying => "flying",
        Phase::Ended => "ended",
    }
}

/// The flight, the link, and how well real time was kept.
fn summary(live: &Live, timing: &Timing) -> String {
    let link = &live.link;
    let mut text = format!("gates      {} passed\n", live.gates);
    let _ = writeln!(
        text,
        "states     {} packets; {} lost, {} late or doubled, {} unusable, {} foreign",
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
