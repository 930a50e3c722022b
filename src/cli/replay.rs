//! `racer replay`: a flight to look at, in Foxglove and in a browser.

use super::{CommandEnd, tell};
use crate::base::check::BadInput;
use crate::base::error::Error;
use crate::base::fsio;
use crate::base::lane::Level;
use crate::flight::{self, Readable};
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::present::replay::{self, Replay};
use crate::present::report;
use crate::present::run;
use crate::race::env::Race;
use crate::race::heat::MOST;
use crate::race::snapshot::{About, Snapshot};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Show a flight in three dimensions: a policy's in the simulator, or a recorded one
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// What to show: a run folder (its best policy), a snapshot file, `latest`, or a flight log
    #[arg(value_name = "RUN|SNAPSHOT|latest|LOG")]
    what: String,
    /// New folder for the files [default: `replay` in the run folder, or beside the log]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Longest flight of a policy, s [default: until each vehicle has flown a lap, at most 30 s]
    #[arg(long, allow_negative_numbers = true, value_parser = super::values::parse_seconds)]
    seconds: Option<f64>,
    /// Vehicles that fly side by side: one nominal, the others randomised as in an evaluation
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=MOST as i64))]
    agents: u32,
    /// Track: a name or a file [default: the policy's own; none for a log]
    #[arg(long, value_name = "NAME|FILE")]
    track: Option<String>,
    /// Vehicle that a policy flies in place of the one it was trained for: a name or a file
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// What a log's fields mean: a mapping's name or file [default: the format's own, or the one that fits]
    #[arg(long, value_name = "NAME|FILE")]
    mapping: Option<String>,
    /// Which flight of a blackbox file, counted from 1 [default: the longest]
    #[arg(long, value_name = "N")]
    flight: Option<usize>,
}

const HELP: &str = "Three files are written. replay.html plays the flight in any browser, without a network: space \
plays, h shows all keys. replay.mcap opens in Foxglove: gates, paths, vehicles, commands, what the policy saw, and a \
log of gates and laps; foxglove-layout.json is a layout for it (Layouts, import from file). A log has to hold position \
and attitude; with --track its gates are shown, and the times at which it passed them.

Exit code 3 means that the log is damaged and that its readable part is shown.

Examples:
  racer replay latest
  racer replay latest --agents 8 --out eight
  racer replay flight.mcap --track a2rl_s2 --out real";

/// Longest flight that is to end with a lap, s.
const LAP_S: f64 = 30.0;
/// The files.
const PAGE: &str = "replay.html";
const MCAP: &str = "replay.mcap";
const LAYOUT: &str = "foxglove-layout.json";

/// Flies or reads, and writes.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let path = Path::new(&args.what);
    let log = path.is_file() && path.extension().is_none_or(|extension| extension != "safetensors");
    let (shown, beside, whole) = if log { recorded(args, path)? } else { flown(args)? };
    let folder = args.out.clone().unwrap_or_else(|| run::free(&beside));
    fsio::new_folder(&folder, "--out")?;
    let layout = serde_json::to_string_pretty(&replay::layout())?;
    for (name, bytes) in [
        (PAGE, report::replay::page(&shown).into_bytes()),
        (MCAP, replay::mcap::mcap(&shown)?),
        (LAYOUT, format!("{layout}\n").into_bytes()),
    ] {
        let path = folder.join(name);
        fsio::write_new(&path, &bytes).map_err(Error::write(&path))?;
    }
    super::print(&summary(&shown))?;
    tell(&format!("{PAGE}, {MCAP} and {LAYOUT} in {}", folder.display()));
    Ok(if whole { CommandEnd::Done } else { CommandEnd::Damaged })
}

/// What is shown, a folder for it, and whether the log could be read to its end.
type OpenedReplay = (Replay, PathBuf, bool);

fn flown(args: &Args) -> anyhow::Result<OpenedReplay> {
    if args.flight.is_some() {
        return Err(refuse("--flight", "a policy", "a flight log, which may hold several"));
    }
    if args.mapping.is_some() {
        return Err(refuse("--mapping", "a policy", "a flight log, whose fields it names"));
    }
    let found = run::find(&args.what)?;
    let Snapshot { network, about } = Snapshot::read(&found.snapshot)?;
    let About { track, vehicle, env, seed, .. } = about;
    let track = args.track.as_deref().map_or(Ok(track), Track::load)?;
    let other = args.vehicle.as_deref().map(Vehicle::load).transpose()?;
    let race = Race::new(&env, &track, other.as_ref().unwrap_or(&vehicle), seed).seen_as(&vehicle);
    let (seconds, one_lap) = (args.seconds.unwrap_or(LAP_S), args.seconds.is_none());
    let shown = replay::race(Level::best(), &race, &track, &network, args.agents as usize, seconds, one_lap);
    let beside = found.run.as_deref().or(found.snapshot.parent()).unwrap_or(Path::new("")).join("replay");
    Ok((shown, beside, true))
}

fn recorded(args: &Args, path: &Path) -> anyhow::Result<OpenedReplay> {
    for (option, given) in
        [("--vehicle", args.vehicle.is_some()), ("--seconds", args.seconds.is_some()), ("--agents", args.agents > 1)]
    {
        if given {
            return Err(refuse(option, "a flight log", "a policy, which is flown anew"));
        }
    }
    let opened = flight::open_with(path, flight::Options { mapping: args.mapping.as_deref(), flight: args.flight })?;
    opened.remarks.iter().for_each(|remark| tell(remark));
    let track = args.track.as_deref().map(Track::load).transpose()?;
    let shown = replay::recorded(&opened.log, track.as_ref())?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let beside = path.with_file_name(format!("{stem}-replay"));
    Ok((shown, beside, opened.log.readable == Readable::Whole))
}

fn refuse(option: &str, found: &str, expected: &str) -> anyhow::Error {
    BadInput::new(option, found, expected, format!("leave {option} out")).into()
}

/// A line for each vehicle.
fn summary(shown: &Replay) -> String {
    let mut text = String::new();
    for vehicle in &shown.vehicles {
        let span = vehicle.frames.first().zip(vehicle.frames.last()).map_or(0.0, |(a, b)| b.time_s - a.time_s);
        let top = vehicle.frames.iter().map(|frame| frame.speed()).filter(|s| s.is_finite()).fold(0.0, f64::max);
        let _ = write!(text, "{}: {span:.1} s, top speed {top:.1} m/s", vehicle.name);
        if shown.track.is_some() {
            let _ = write!(text, ", {} gates passed", vehicle.passes.len());
        }
        if !vehicle.laps.is_empty() {
            let laps: Vec<_> = vehicle.laps.iter().map(|lap| format!("{lap:.2}")).collect();
            let _ = write!(text, ", laps {} s", laps.join(", "));
        }
        if let Some(failure) = &vehicle.failure {
            let _ = write!(text, ", ended by {failure}");
        }
        text.push('\n');
    }
    text.trim_end().into()
}
