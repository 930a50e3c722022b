//! `racer diagnose`: what the simulation gets wrong, and why.

mod changes;
mod next;
mod output;
mod text;
mod thresholds;
mod worth;

use super::{CommandEnd, logs, progress};
use crate::base::check::{BadInput, Invalid};
use crate::base::fsio;
use crate::flight::Options;
use crate::insight::diagnose::judgement::diagnosis::Verdict;
use crate::insight::diagnose::{Diagnosed, diagnose};
use crate::insight::identify::{self, identify};
use crate::insight::plan::next_flight;
use crate::insight::quality::{Quality, together};
use crate::model::vehicle::Vehicle;
use crate::present::run;
use indicatif::ProgressBar;
use output::OutputFiles;
use std::path::PathBuf;
use thresholds::Thresholds;

/// Show what the simulation gets wrong, name the cause, and extend the model
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Logs of one vehicle in the order of flight: MCAP, Betaflight blackbox, PX4 ULog or CSV
    #[arg(required_unless_present = "criteria", value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// An earlier log of the same vehicle; give it once for each: what changed since is named first
    #[arg(long, value_name = "LOG")]
    against: Vec<PathBuf>,
    /// The vehicle that the simulation takes it for: a name or a file [default: identified from the logs, the
    /// earlier ones with --against]
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// New file for everything that was found, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// New file for the extended vehicle, which `racer train --vehicle` reads
    #[arg(long, value_name = "V.toml")]
    extend: Option<PathBuf>,
    /// New file for the report with figures, one page
    #[arg(long, value_name = "F.html")]
    report: Option<PathBuf>,
    /// New or empty folder for the figures, one SVG file each
    #[arg(long, value_name = "DIR")]
    svg: Option<PathBuf>,
    /// Fly this policy with and without what was found: a run folder, a snapshot file, or `latest`
    #[arg(long, value_name = "RUN|SNAPSHOT|latest")]
    policy: Option<String>,
    /// Train a policy in the base and one in the extended vehicle for so many minutes each, and fly both in the
    /// extended one
    #[arg(long, value_name = "MINUTES")]
    retrain: Option<f64>,
    /// New folder for the policies of --retrain [default: retrained]
    #[arg(long, value_name = "DIR", default_value = "retrained", requires = "retrain")]
    retrain_out: PathBuf,
    /// Say what these flights could show and tell apart, and plan the shortest flight that tells what is tied
    #[arg(long)]
    plan: bool,
    /// New file for the planned flight, which `racer fly --pilot --plan` flies; implies --plan
    #[arg(long, value_name = "P.toml")]
    plan_out: Option<PathBuf>,
    /// End with exit code 5 where an effect or unexplained structure is found
    #[arg(long)]
    fail_on_effect: bool,
    /// End with exit code 5 where something changed since the logs of --against
    #[arg(long, requires = "against")]
    fail_on_change: bool,
    /// What the logs' fields mean: a mapping's name or file [default: the format's own, or the one that fits]
    #[arg(long, value_name = "NAME|FILE")]
    mapping: Option<String>,
    /// Which flight of a blackbox file, counted from 1 [default: the longest]
    #[arg(long, value_name = "N")]
    flight: Option<usize>,
    /// Go on where a log contradicts itself, such as a rate that goes against its setpoint, or where logs contradict
    /// each other about their vehicle
    #[arg(long)]
    despite_problems: bool,
    /// In place of --vehicle: the vehicle that lends what the logs cannot tell
    #[arg(long, value_name = "NAME|FILE", default_value = "seed_class", conflicts_with = "vehicle")]
    base: String,
    #[command(flatten)]
    thresholds: Thresholds,
}

const HELP: &str = "The flight is predicted from its commands by the simulator's own equations. What the residuals \
show is tested against a catalogue of effects; those that are evident, replicated, of a size that matters, and leave \
nothing structured behind, are named, with what they are worth on flight that was not used for fitting.

With --against, both sets of flights are fitted as one vehicle's. What differs between them is named, with its size \
before and after; what both show is the vehicle's, and so is what the model gets wrong of both alike. The rest of the \
report is about the later flights.

With --plan, every manoeuvre of the pilot is flown in the simulator in the vehicle as identified. The flight that is \
planned holds those that tell causes apart that take each other's place in these flights, or, where there are none, \
that show what these flights could not.

Exit code 3 means that a log is damaged and that its readable part was used, 5 that --fail-on-effect or \
--fail-on-change found something.

Examples:
  racer diagnose flight.mcap --vehicle mine.toml
  racer diagnose flight.mcap --vehicle mine.toml --report diagnosis.html
  racer diagnose flight.mcap --vehicle mine.toml --extend better.toml
  racer diagnose today.mcap --against yesterday.mcap
  racer diagnose flight.mcap --plan-out plan.toml";

/// Reads, checks, diagnoses, prints, writes.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    args.thresholds.scale()?;
    if args.thresholds.criteria {
        super::print(&thresholds::list()?)?;
        return Ok(CommandEnd::Done);
    }
    let output = OutputFiles::new(args)?;
    let given = args.vehicle.as_deref().map(Vehicle::load).transpose()?;
    check_racing(args)?;
    let bar = progress::bar();
    let mut before = read(args, &bar)?;
    let damaged = logs::damaged(&before);
    let logs = before.split_off(args.against.len());
    // What changed is told against what the vehicle was.
    let base = given.map_or_else(|| identified(args, if before.is_empty() { &logs } else { &before }, &bar), Ok)?;
    let mut watch = |step: &str, share: f64| {
        bar.set_position((100.0 * share) as u64);
        bar.set_message(step.to_string());
    };
    let mut changes = changes::find(before, &logs, &base, &mut watch);
    let diagnosed = diagnose(logs, &base, &mut watch);
    changes.iter_mut().for_each(|changes| changes.confirm(&diagnosed.diagnosis));
    let diagnosed = Diagnosed { changes, ..diagnosed };
    let plans = args.plan || args.plan_out.is_some();
    let next = plans.then(|| next_flight(&diagnosed, &base, &mut watch));
    bar.finish_and_clear();
    let diagnosis = &diagnosed.diagnosis;
    let changed = diagnosed.changes.as_ref();
    if let Some(changes) = changed {
        super::print(&(changes::text(changes) + "\n\nthe later flights by themselves:\n"))?;
    }
    super::print(&if plans { text::plan(diagnosis) } else { text::text(diagnosis) })?;
    if let Some(next) = &next {
        let file = args.plan_out.as_deref().filter(|_| !next.manoeuvres.is_empty());
        super::print(&(String::from("\n\n") + &next::text(next, file)))?;
    }
    output.write(&diagnosed, next.as_ref())?;
    if let Some(policy) = &args.policy {
        super::print(&worth::present(policy, &base, extended(&diagnosed, "--policy")?)?)?;
    }
    if let Some(minutes) = args.retrain {
        super::print(&worth::retrained(&args.retrain_out, minutes, &base, extended(&diagnosed, "--retrain")?)?)?;
    }
    let effect = args.fail_on_effect && diagnosis.verdict != Verdict::Clean;
    let change = args.fail_on_change && changed.is_some_and(|changes| changes.changed);
    Ok(if effect || change {
        CommandEnd::Effect
    } else if damaged {
        CommandEnd::Damaged
    } else {
        CommandEnd::Done
    })
}

/// The logs, the earlier ones first; fails where they cannot be taken together.
fn read(args: &Args, bar: &ProgressBar) -> anyhow::Result<Vec<Quality>> {
    let all: Vec<PathBuf> = args.against.iter().chain(&args.logs).cloned().collect();
    let all = logs::read(&all, Options { mapping: args.mapping.as_deref(), flight: args.flight }, bar)?;
    together::flights(&all)?;
    let (before, after) = all.split_at(args.against.len());
    if !args.despite_problems {
        identify::refuse::problems(&all)?;
        together::kinds(&all)?;
        // Between the sets it may be what changed.
        for set in [before, after] {
            together::masses(set)?;
            // A vehicle that is given says its own.
            if args.vehicle.is_none() {
                together::full_rates(set)?;
            }
        }
    }
    changes::check(before, after)?;
    Ok(all)
}

/// The extended vehicle that `option` asks for.
fn extended<'a>(diagnosed: &'a Diagnosed, option: &str) -> Result<&'a Vehicle, BadInput> {
    let none = |why: &String| {
        let advice =
            "no vehicle is written rather than a worse one: diagnose more flights together, or leave the option out";
        BadInput::new(option, why, "an extended vehicle that predicts unseen flight no worse", advice)
    };
    diagnosed.vehicle.as_ref().map_err(none)
}

/// Whether policies can be flown and trained as was asked for: known before the diagnosis, which takes its time.
fn check_racing(args: &Args) -> Result<(), BadInput> {
    if let Some(policy) = &args.policy {
        run::find(policy)?;
    }
    let Some(minutes) = args.retrain else { return Ok(()) };
    Invalid::unless_positive("--retrain", minutes, "").map_err(|invalid| BadInput::at("command line", invalid))?;
    fsio::new_folder(&args.retrain_out, "--retrain-out")
}

/// The vehicle, where only the logs say what it is.
fn identified(args: &Args, logs: &[Quality], bar: &ProgressBar) -> Result<Vehicle, BadInput> {
    let options = identify::IdentifyOptions::new(Vehicle::load(&args.base)?);
    let found = identify(logs.to_vec(), &options, &mut |step, _| bar.set_message(format!("identifying: {step}")));
    Ok(found.vehicle)
}
