//! `racer bench`: how fast this machine is.

mod parts;

use super::values::threads;
use super::{CommandEnd, tell};
use crate::base::lane::Level;
use crate::base::peak;
use crate::learn::ppo::Environment;
use crate::present::bench::threads::ThreadsModel;
use crate::present::bench::{BenchFigures, Pair, PeakShares, measure, training_flops_per_step};
use crate::race::config::{DEFAULT, Setting, Setup};
use crate::race::env::Race;
use serde::Serialize;
use std::time::Duration;

/// Measure simulation and training on this machine, beside its own limit
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Configuration to measure: a name or a file, as in `racer train`
    #[arg(long, value_name = "NAME|FILE", default_value = DEFAULT)]
    config: String,
    /// Change one key of the configuration; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print JSON in place of the table
    #[arg(long)]
    json: bool,
    /// Threads of the second column [default: all processors]
    #[arg(long, value_parser = super::values::parse_threads)]
    threads: Option<usize>,
    /// Time to measure for, about, s
    #[arg(long, allow_negative_numbers = true, default_value_t = 20.0, value_parser = parse_seconds)]
    seconds: f64,
    /// Measure instead what the parts of an optimiser step cost on one thread
    #[arg(long)]
    parts: bool,
    /// Measure instead what of training threads share, and predict its speed on 1 to 64
    #[arg(long)]
    threads_model: bool,
}

const HELP: &str = "Figures are environment steps of 10 ms a second:
  physics      the equations of motion alone, commands held
  environment  observation, noise, motion, gates, reward, ends and resets; commands held, no policy
  rollout      the environment flown by the stochastic policy, stored for learning
  training     rollout, advantages and all epochs of the update
The peak is that of single-precision multiply-adds, each counted as two operations. Shares of it are those on all \
threads: of physics and environment, every operation counts as if it were a multiply-add; of training, only the \
networks' multiply-adds count; of rollout, both. A share does not depend on the machine's speed, so a loss shows in \
it. A number goes from one processor's cache to another's and back in about 60 ns on one die, in 300 and more between \
two, where threads share an update less well; a virtual machine may be moved from one to the other at any time.

--threads-model counts what of an iteration threads can share and what one does alone; clocks that fall when more \
processors work, and the memory that they share, it leaves out.";

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.01..=600.0).contains(&seconds) => Ok(seconds),
        _ => Err("expected 0.01 to 600".into()),
    }
}

/// What `--json` prints: names and shapes that scripts rely on.
#[derive(Serialize)]
struct BenchReport<'a> {
    physics_steps_per_s: Pair,
    environment_steps_per_s: Pair,
    rollout_steps_per_s: Pair,
    training_steps_per_s: Pair,
    /// All threads.
    peak_flops_per_s: f64,
    training_peak_share: f64,
    peak_flops_per_s_one_thread: f64,
    training_peak_share_one_thread: f64,
    training_flops_per_step: f64,
    peak_shares: PeakShares,
    round_trip_s: f64,
    threads: usize,
    simd: &'a str,
}

/// Measures and prints.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let settings = args.set.iter().map(|text| Setting::parse(text)).collect::<Result<Vec<_>, _>>()?;
    let Setup { config, track, vehicle } = Setup::load(&args.config, &settings)?;
    tell(&format!("measuring, about {:.0} s", args.seconds));
    let time = Duration::from_secs_f64(args.seconds);
    if args.parts || args.threads_model {
        return model(args, &Setup { config, track, vehicle }, time);
    }
    let figures = measure(&config, &track, &vehicle, Level::best(), threads(args.threads), time);
    let text = if args.json { serde_json::to_string_pretty(&report(&figures))? } else { table(&figures) };
    super::print(&text)?;
    Ok(CommandEnd::Done)
}

/// Where training spends its time.
fn model(args: &Args, setup: &Setup, time: Duration) -> anyhow::Result<CommandEnd> {
    let Setup { config, track, vehicle } = setup;
    let race = Race::new(&config.env, track, vehicle, config.seed);
    let level = Level::best();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let peak = one.install(|| peak::flops_per_s(level, time / 10));
    let model = ThreadsModel::measure(config, &race, level, threads(args.threads), time.mul_f64(0.9));
    let [rollout, epoch] = [0, 1].map(|epochs| training_flops_per_step(race.observations(), epochs));
    let flops = (epoch - rollout) * (model.batch / config.ppo.minibatches) as f64;
    let tables = [(args.parts, parts::parts(&model, flops, peak)), (args.threads_model, parts::threads(&model))];
    super::print(&match args.json {
        true => serde_json::to_string_pretty(&parts::document(&model))?,
        false => tables.into_iter().filter(|(asked, _)| *asked).map(|(_, text)| text).collect::<Vec<_>>().join("\n\n"),
    })?;
    Ok(CommandEnd::Done)
}

fn report(figures: &BenchFigures) -> BenchReport<'_> {
    BenchReport {
        physics_steps_per_s: figures.physics_steps_per_s,
        environment_steps_per_s: figures.environment_steps_per_s,
        rollout_steps_per_s: figures.rollout_steps_per_s,
        training_steps_per_s: figures.training_steps_per_s,
        peak_flops_per_s: figures.peak_flops_per_s.all_threads,
        training_peak_share: figures.training_peak_share,
        peak_flops_per_s_one_thread: figures.peak_flops_per_s.one_thread,
        training_peak_share_one_thread: figures.training_peak_share_one_thread,
        training_flops_per_step: figures.training_flops_per_step,
        peak_shares: figures.peak_shares,
        round_trip_s: figures.round_trip_s,
        threads: figures.threads,
        simd: &figures.simd,
    }
}

fn table(figures: &BenchFigures) -> String {
    let row = |name: &str, pair: Pair, unit: f64, unit_name: &str, share: &str| {
        let [one, all] = [pair.one_thread, pair.all_threads].map(|value| value / unit);
        let line = format!("{name:<14}{one:>12.2}{all:>14.2}   {unit_name:<12}{share}");
        line.trim_end().to_string() + "\n"
    };
    let stage = |name: &str, pair: Pair, share: Pair| {
        row(name, pair, 1e6, "M steps/s", &format!("{:>4.1} % of the peak", 100.0 * share.all_threads))
    };
    let threads = match figures.threads {
        1 => "1 thread".into(),
        threads => format!("{threads} threads"),
    };
    let shares = &figures.peak_shares;
    let rows = [
        stage("physics", figures.physics_steps_per_s, shares.physics),
        stage("environment", figures.environment_steps_per_s, shares.environment),
        stage("rollout", figures.rollout_steps_per_s, shares.rollout),
        stage("training", figures.training_steps_per_s, shares.training),
        row("peak", figures.peak_flops_per_s, 1e9, "GFLOP/s", ""),
    ];
    let away = 1e9 * figures.round_trip_s;
    let caches = format!("{:<14}{:>12}{away:>14.0}   ns from one thread to another and back", "caches", "");
    format!("{:<14}{:>12}{threads:>14}   {}\n{}{caches}", "", "1 thread", figures.simd, rows.concat())
}
