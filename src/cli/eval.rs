//! `racer eval`: what a policy is worth.

use super::{CommandEnd, sensitivity, table, tell};
use crate::base::check::BadInput;
use crate::base::fsio::Reserved;
use crate::base::lane::Level;
use crate::base::threads;
use crate::learn::nn::Network;
use crate::model::vehicle::Vehicle;
use crate::present::run::{self, FoundPolicy};
use crate::race::env::Race;
use crate::race::env::reset::StartPlace;
use crate::race::eval::pace::Pace;
use crate::race::eval::{EvalConfig, Report, benchmark};
use crate::race::snapshot::{About, Snapshot};
use clap::ValueEnum;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Fly a policy with many randomised vehicles and score it
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// A run folder (its best policy), a snapshot file, or `latest` for the youngest run below runs/
    #[arg(value_name = "RUN|SNAPSHOT|latest")]
    policy: String,
    /// Vehicle to fly in place of the one it was trained for: a name or a file
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Where the agents start: on the pad, along the track, or one after the other
    #[arg(long, value_enum, default_value_t = Starts::Both)]
    start: Starts,
    /// Vehicles: one nominal, all others with every factor drawn [default: as configured, 512]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    agents: Option<u32>,
    /// Fly nominal vehicles in which one parameter at a time is wrong by a factor of 0.5 to 1.5, and print what that
    /// costs; from the pad, with the noise of the training, without which all flights of a cell would be one [default:
    /// 128 agents in each cell]
    #[arg(long, conflicts_with_all = ["start", "require"])]
    sensitivity: bool,
    /// Exit with code 4 where a smaller share than this of the fixed-start agents completes a lap
    #[arg(long, value_name = "SHARE", value_parser = parse_share)]
    require: Option<f64>,
    /// Print JSON in place of the table
    #[arg(long)]
    json: bool,
    /// New file for the JSON [default: evaluation-[VEHICLE-]START-AGENTS.json beside the policy]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Threads [default: all processors]; changes the speed, not the result
    #[arg(long, value_parser = super::values::parse_threads)]
    threads: Option<usize>,
}

const HELP: &str = "The deterministic mean policy flies without observation or action noise through the gates' full \
apertures, for at most 1000 steps unless configured otherwise. The paper deploys a policy where 95 % of fixed-start \
agents complete a lap: `racer eval latest --require 0.95`.

Laps are measured flying, from a crossing of the first gate to its next. The reference lap beside them is that of a \
point mass with the vehicle's thrust and least drag (`racer track show --help`); the ratio of a policy is always above \
1.";

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Starts {
    Fixed,
    Random,
    Both,
}

fn parse_share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("expected a share, 0 to 1".into()),
    }
}

/// What is written and, with `--json`, printed.
#[derive(Serialize)]
struct EvalDocument<'a> {
    snapshot: String,
    track: &'a str,
    /// The vehicle that was flown, and the one that it was trained for.
    vehicle: &'a str,
    trained_vehicle: &'a str,
    /// Steps it was trained for.
    steps: u64,
    seed: u64,
    max_steps: usize,
    #[serde(flatten)]
    report: &'a Report,
    /// The median laps beside the reference lap of the vehicle that was flown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pace: &'a Option<Pace>,
}

/// Evaluates, prints and writes.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    if args.require.is_some() && args.start == Starts::Random {
        let advice = "leave --start out, or --require";
        return Err(BadInput::new("--require", "--start random", "fixed starts, which it is about", advice).into());
    }
    let found = run::find(&args.policy)?;
    let Snapshot { network, about } = Snapshot::read(&found.snapshot)?;
    let mut config = about.eval.clone();
    config.agents = args.agents.map_or(config.agents, |agents| agents as usize);
    let other = args.vehicle.as_deref().map(Vehicle::load).transpose()?;
    if args.sensitivity {
        config.agents = args.agents.map_or(sensitivity::AGENTS, |agents| agents as usize);
        return sensitive(args, &found, other.as_ref(), &network, &about, &config);
    }
    let file = reserve(args, || default_file(&found, other.as_ref(), args.start, config.agents))?;

    let vehicle = other.as_ref().unwrap_or(&about.vehicle);
    let race = Race::new(&about.env, &about.track, vehicle, about.seed).seen_as(&about.vehicle);
    let fly = |place| benchmark(Level::best(), &race, &about.track, &network, place, &config).0;
    let report = threads::on(args.threads, || Report {
        fixed: (args.start != Starts::Random).then(|| fly(StartPlace::Pad)),
        random: (args.start != Starts::Fixed).then(|| fly(StartPlace::Spline)),
    })?;
    let pace = Pace::of(&report, &about.track, vehicle);
    let content = EvalDocument {
        snapshot: found.snapshot.display().to_string(),
        track: &about.track.name,
        vehicle: &vehicle.name,
        trained_vehicle: &about.vehicle.name,
        steps: about.steps,
        seed: about.seed,
        max_steps: config.max_steps,
        report: &report,
        pace: &pace,
    };
    let json = serde_json::to_string_pretty(&content)?;
    let written = file.write(format!("{json}\n").as_bytes())?;
    if args.json {
        super::print(&json)?;
    } else {
        let million = about.steps as f64 / 1e6;
        let flown = other.as_ref().map_or(String::new(), |other| format!(" in {}", other.name));
        let title = format!("{} on {}{flown} after {million:.1} M steps", content.snapshot, content.track);
        super::print(&format!("{title}\n\n{}{}", table::report(&report), table::pace(pace.as_ref())))?;
    }
    tell(&format!("written to {}", written.display()));
    Ok(judge(args.require, &report))
}

/// `--sensitivity`.
fn sensitive(
    args: &Args,
    found: &FoundPolicy,
    other: Option<&Vehicle>,
    network: &Network<f32>,
    about: &About,
    config: &EvalConfig,
) -> anyhow::Result<CommandEnd> {
    let vehicle = other.unwrap_or(&about.vehicle);
    let race = Race::new(&about.env, &about.track, vehicle, about.seed).seen_as(&about.vehicle);
    let out = reserve(args, || beside(found, &format!("sensitivity-{}{}.json", named(other), config.agents)))?;
    let flown = sensitivity::Case { race: &race, track: &about.track, network, config };
    let snapshot = found.snapshot.display().to_string();
    sensitivity::run(&snapshot, &flown, args.threads, args.json, out)
}

fn judge(require: Option<f64>, report: &Report) -> CommandEnd {
    let (completion, Some(share)) = (report.completion(), require) else { return CommandEnd::Done };
    if completion >= share {
        return CommandEnd::Done;
    }
    tell(&format!("{:.1} % of fixed starts completed a lap; {:.1} % are required", 100.0 * completion, 100.0 * share));
    CommandEnd::NotMet
}

/// The file that was asked for, or `default`, numbered where others have that name: evaluations may run side by side.
fn reserve(args: &Args, default: impl Fn() -> PathBuf) -> Result<Reserved, BadInput> {
    match &args.out {
        Some(path) => Reserved::new(path, "--out"),
        None => Reserved::numbered(&default(), "--out"),
    }
}

/// A name that says what was measured.
fn default_file(found: &FoundPolicy, other: Option<&Vehicle>, start: Starts, agents: usize) -> PathBuf {
    let start = format!("{start:?}").to_lowercase();
    beside(found, &format!("evaluation-{}{start}-{agents}.json", named(other)))
}

/// The other vehicle as part of a name.
fn named(other: Option<&Vehicle>) -> String {
    other.map_or(String::new(), |other| format!("{}-", run::plain(&other.name)))
}

/// A file of this name beside the policy, which a snapshot's name leads.
fn beside(found: &FoundPolicy, name: &str) -> PathBuf {
    let name = match &found.run {
        Some(_) => name.into(),
        None => format!("{}-{name}", found.snapshot.file_stem().unwrap_or_default().to_string_lossy()),
    };
    let folder = found.run.as_deref().or(found.snapshot.parent()).unwrap_or(Path::new(""));
    folder.join(name)
}
