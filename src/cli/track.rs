//! `racer track`: what a track is like, and how fast it could be flown.

use super::{CommandEnd, columns, tell};
use crate::base::fsio::Reserved;
use crate::model::track::{GateKind, Section, Shape, Track};
use crate::model::vehicle::Vehicle;
use crate::present::report::lap;
use crate::race::reference::{self, METHOD, Reference};
use serde::Serialize;
use std::path::PathBuf;

/// Look at a track
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: TrackCommand,
}

#[derive(Debug, clap::Subcommand)]
enum TrackCommand {
    Show(Show),
}

/// Print gates, sections, length and curvature of a track, and a reference lap
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
struct Show {
    /// A track: a name or a file
    #[arg(value_name = "NAME|FILE")]
    track: String,
    /// Vehicle of the reference lap: a name or a file
    #[arg(long, value_name = "NAME|FILE", default_value = "seed_class")]
    vehicle: String,
    /// Print JSON in place of text
    #[arg(long)]
    json: bool,
    /// New file for a picture of the reference lap from above, on a fresh battery
    #[arg(long, value_name = "F.svg")]
    svg: Option<PathBuf>,
}

const HELP: &str = "The reference lap is the fastest closed lap of a point mass: it has the vehicle's full thrust at \
the stated voltage, in any direction at any time, gravity, and the drag of the attitude in which the vehicle has \
least; it crosses every aperture anywhere within the radius that a pass is scored by, in the gate's direction, stays \
in the track's volume, and ends as fast as it began. A vehicle has to turn before it can push, and flies in attitudes \
that brake more: it stays slower. The lap is transcribed directly (places at equal times, accelerations by \
differences) and its time minimised by Newton's method through logarithmic barriers, from several first laps, then \
refined twice. It is a local optimum, not a proven bound. Effects beyond the compact model are left out.

Length and curvature are those of the reset spline, the paper's Catmull-Rom curve from the start through all gates.

Examples:
  racer track show a2rl_s2
  racer track show mine.toml --vehicle a2rl_class --svg reference.svg";

/// What `--json` prints.
#[derive(Serialize)]
struct TrackDocument<'a> {
    track: &'a str,
    vehicle: &'a str,
    gates: Vec<GateLine<'a>>,
    sections: &'a [Section],
    reset_spline: Shape,
    method: &'static str,
    reference_laps: Vec<Lap>,
}

#[derive(Serialize)]
struct GateLine<'a> {
    label: String,
    #[serde(flatten)]
    gate: &'a crate::model::track::Gate,
    /// Along the reset spline, m.
    at_m: f64,
}

#[derive(Serialize)]
struct Lap {
    battery: &'static str,
    voltage_v: f64,
    /// None where the vehicle cannot carry itself.
    seconds: Option<f64>,
    length_m: Option<f64>,
    top_speed_m_s: Option<f64>,
}

pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let TrackCommand::Show(show) = &args.command;
    let (track, vehicle) = (Track::load(&show.track)?, Vehicle::load(&show.vehicle)?);
    let file = show.svg.as_deref().map(|path| Reserved::new(path, "--svg")).transpose()?;
    let battery = &vehicle.battery;
    let laps = [("fresh", battery.full_v), ("half", battery.at(0.5))];
    let laps = laps.map(|(name, voltage)| (name, voltage, reference::lap(&track, &vehicle, voltage)));
    if let Some(file) = file {
        let Some(fresh) = &laps[0].2 else { anyhow::bail!("there is no reference lap to draw") };
        let title = format!("{}: reference lap of {}, {:.2} s", track.name, vehicle.name, fresh.seconds);
        tell(&format!("picture in {}", file.write(lap::reference(&track, fresh, &title)?.as_bytes())?.display()));
    }
    let document = document(&track, &vehicle, &laps);
    super::print(&if show.json { serde_json::to_string_pretty(&document)? } else { text(&track, &document) })?;
    Ok(CommandEnd::Done)
}

fn document<'a>(
    track: &'a Track,
    vehicle: &'a Vehicle,
    laps: &[(&'static str, f64, Option<Reference>)],
) -> TrackDocument<'a> {
    let spline = track.reset_spline();
    let gates = track.gates.iter().enumerate();
    let lap = |(battery, voltage_v, lap): &(&'static str, f64, Option<Reference>)| Lap {
        battery,
        voltage_v: *voltage_v,
        seconds: lap.as_ref().map(|lap| lap.seconds),
        length_m: lap.as_ref().map(|lap| lap.length),
        top_speed_m_s: lap.as_ref().map(|lap| lap.top_speed),
    };
    TrackDocument {
        track: &track.name,
        vehicle: &vehicle.name,
        gates: gates
            .map(|(i, gate)| GateLine { label: track.gate_label(i), gate, at_m: spline.length_at(i + 1) })
            .collect(),
        sections: &track.sections,
        reset_spline: track.shape(),
        method: METHOD,
        reference_laps: laps.iter().map(lap).collect(),
    }
}

fn text(track: &Track, document: &TrackDocument) -> String {
    let gates = document.gates.iter().map(|GateLine { label, gate, at_m }| {
        let [x, y, z] = gate.position_m.map(|x| format!("{x:.2}"));
        let heading = format!("{:.0}", gate.heading_deg);
        let kind = match gate.kind {
            GateKind::Physical => "",
            GateKind::Virtual => "virtual",
        };
        vec![label.clone(), x, y, z, heading, format!("{:.2}", gate.radius_m), format!("{at_m:.1}"), kind.into()]
    });
    let header = ["gate", "x, m", "y, m", "z, m", "heading, deg", "radius, m", "along spline, m", ""];
    let sections: String = track.sections.iter().map(|section| section_line(track, section)).collect();
    let Shape { length_m, curvature_1_m, at_m, gate, .. } = document.reset_spline;
    let laps = document.reference_laps.iter().map(|lap| {
        let number = |value: Option<f64>, digits: usize| value.map_or("none".into(), |x| format!("{x:.digits$}"));
        let mean = lap.length_m.zip(lap.seconds).map(|(length, seconds)| length / seconds);
        vec![
            format!("{} battery, {:.1} V", lap.battery, lap.voltage_v),
            number(lap.seconds, 3),
            number(lap.length_m, 1),
            number(mean, 1),
            number(lap.top_speed_m_s, 1),
        ]
    });
    let laps = columns::table(&["", "s", "m", "mean m/s", "top m/s"], laps.collect(), 1..5);
    format!(
        "{}\n\n{}\n\n{sections}reset spline: {length_m:.1} m, sharpest {curvature_1_m:.2} 1/m (radius {:.2} m) at \
         {at_m:.1} m, on the way to gate {}\n\nreference lap of {}\n{laps}\n\n{}",
        document.track,
        columns::table(&header, gates.collect(), 1..7),
        1.0 / curvature_1_m,
        track.gate_label(gate),
        document.vehicle,
        document.method,
    )
}

fn section_line(track: &Track, section: &Section) -> String {
    let gates: Vec<_> = section.gates.iter().map(|&gate| track.gate_label(gate)).collect();
    format!("{}: gates {}\n", section.name, gates.join(", "))
}
