//! `racer train`: a policy from a track.

use super::training::ShownTraining;
use super::values::threads;
use super::{CommandEnd, interrupt, tell};
use crate::base::check::BadInput;
use crate::base::lane::bf16::Bf16Unit;
use crate::learn::ppo::config::ProductPrecision;
use crate::present::run::{Run, folder};
use crate::present::train::{Ended, make, resume, room};
use crate::race::config::{DEFAULT, Setting, Setup};
use std::path::{Path, PathBuf};

/// Train a policy, evaluate every snapshot of it and keep the best
#[derive(Debug, clap::Args)]
#[command(after_help = HELP, after_long_help = long_help())]
pub struct Args {
    /// Configuration: a name or a file, looked for here, in configs/ and among the built-in ones
    #[arg(long, value_name = "NAME|FILE", default_value = DEFAULT)]
    config: String,
    /// Track: a name or a file, looked for here, in tracks/ and among the built-in ones
    #[arg(long, value_name = "NAME|FILE")]
    track: Option<String>,
    /// Vehicle: a name or a file, looked for here, in configs/vehicles/ and among the built-in ones
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Change one key of the configuration; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Where all random numbers start; the same seed and steps give the same policy on any number of threads
    #[arg(long, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: Option<u64>,
    /// Train for so many minutes
    #[arg(long, allow_negative_numbers = true, conflicts_with = "steps")]
    minutes: Option<f64>,
    /// Train for so many environment steps, rounded up to whole rollouts
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=i64::MAX as u64))]
    steps: Option<u64>,
    /// Threads [default: all processors]; changes the speed, not the result
    #[arg(long, value_parser = super::values::parse_threads)]
    threads: Option<usize>,
    /// New folder for the run [default: one below runs/, named by time and track]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Go on with a training that was stopped or killed, from its last checkpoint, as if it had never stopped;
    /// `latest` is the youngest run below runs/
    #[arg(long, value_name = "RUN|latest", conflicts_with_all = OTHERS)]
    resume: Option<PathBuf>,
    /// End at once, without saving, when standard input ends: how a study takes its trainings along
    #[arg(long, hide = true)]
    attached: bool,
}

/// What a run that is gone on with has already.
const OTHERS: [&str; 8] = ["config", "track", "vehicle", "set", "seed", "minutes", "steps", "out"];

const HELP: &str =
    "A file needs only the keys that differ from the built-in a2rl.toml. Ctrl-C finishes the update and saves. A run \
is written as it is trained: TensorBoard, `racer eval RUN` and `racer report RUN` work on what there is.

Examples:
  racer train
  racer train --track uzh_split_s --minutes 2 --set ppo.learning_rate=3e-4
  racer train --config runs/RUN/config.toml --seed 2
  racer train --resume runs/RUN";

/// The help with all keys of the configuration.
fn long_help() -> String {
    format!("{HELP}\n\nThe built-in a2rl.toml:\n\n{}", include_str!("../../configs/a2rl.toml"))
}

impl Args {
    /// What the options change in the configuration, in the order of precedence.
    fn settings(&self) -> Result<Vec<Setting>, BadInput> {
        let mut settings = self.set.iter().map(|text| Setting::parse(text)).collect::<Result<Vec<_>, _>>()?;
        settings.extend(self.track.as_deref().map(|track| Setting::of("--track", "track", track)));
        settings.extend(self.vehicle.as_deref().map(|vehicle| Setting::of("--vehicle", "vehicle", vehicle)));
        settings.extend(self.seed.map(|seed| Setting::of("--seed", "seed", seed as i64)));
        settings.extend(self.minutes.map(|minutes| Setting::of("--minutes", "budget.minutes", minutes)));
        settings.extend(self.steps.map(|steps| Setting::of("--steps", "budget.steps", steps as i64)));
        Ok(settings)
    }
}

/// Trains, saves, evaluates.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    if let Some(of) = &args.resume {
        return go_on(args, &folder(of)?);
    }
    let setup = Setup::load(&args.config, &args.settings()?)?;
    room::check(&setup)?;
    if setup.config.ppo.precision == ProductPrecision::Bf16 && Bf16Unit::best() == Bf16Unit::Portable {
        tell("This processor has no instruction for bf16: without `ppo.precision=bf16` it trains many times as fast.");
    }
    let run = Run::create(args.out.as_deref(), &setup.track.name)?;
    let mut shown = ShownTraining::new();
    if args.attached {
        interrupt::end_with_standard_input();
    }
    let command = std::env::args_os().map(|word| quote(&word.to_string_lossy())).collect::<Vec<_>>().join(" ");
    match make(&run, &setup, threads(args.threads), &command, &mut shown)? {
        Ended::Finished(_) => Ok(CommandEnd::Done),
        Ended::Stopped { steps } => {
            stopped(&run, steps);
            Ok(CommandEnd::Interrupted)
        }
    }
}

/// Goes on with the training in `folder`.
fn go_on(args: &Args, folder: &Path) -> anyhow::Result<CommandEnd> {
    let mut shown = ShownTraining::new();
    if args.attached {
        interrupt::end_with_standard_input();
    }
    match resume(folder, threads(args.threads), &mut shown)? {
        None => {
            tell(&format!("{0} is finished: nothing is left to train.\n  racer eval {0}", folder.display()));
            Ok(CommandEnd::Done)
        }
        Some(Ended::Finished(_)) => Ok(CommandEnd::Done),
        Some(Ended::Stopped { steps }) => {
            stopped(&Run { folder: folder.into() }, steps);
            Ok(CommandEnd::Interrupted)
        }
    }
}

/// A word as a shell reads it back.
fn quote(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=./:,+".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

fn stopped(run: &Run, steps: u64) {
    let folder = run.folder.display();
    tell(&format!(
        "Stopped after {:.1} M steps; everything so far is in {folder}.\n  \
         racer eval {folder}            evaluates the last policy\n  \
         racer train --resume {folder}  goes on to the end",
        steps as f64 / 1e6
    ));
}
