//! `racer bench`: how fast this machine is.

use super::{Outcome, tell};
use crate::bench::{Figures, Rate, measure, threads};
use crate::config::{DEFAULT, Setup};
use crate::lane::Level;
use std::time::Duration;

/// Measure simulation and training on this machine, beside its own limit
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Print JSON in place of the table
    #[arg(long)]
    json: bool,
    /// Threads of the second column [default: all processors]
    #[arg(long, value_parser = super::parse_threads)]
    threads: Option<usize>,
    /// Time for each figure, s
    #[arg(long, allow_negative_numbers = true, default_value_t = 2.0, value_parser = parse_seconds)]
    seconds: f64,
}

const HELP: &str = "Figures are environment steps of 10 ms a second, with the default configuration:
  physics      the equations of motion alone, commands held
  environment  observation, noise, motion, gates, reward, ends and resets; commands held, no policy
  rollout      the environment flown by the stochastic policy, stored for learning
  training     rollout, advantages and all epochs of the update
The peak is that of single-precision multiply-adds, each counted as two operations; training's share of it counts the
networks' multiply-adds and nothing else.";

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.01..=600.0).contains(&seconds) => Ok(seconds),
        _ => Err("expected 0.01 to 600".into()),
    }
}

/// Measures and prints.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let setup = Setup::load(DEFAULT, &[])?;
    let (level, threads) = (Level::best(), threads(args.threads));
    tell(&format!("measuring, about {:.0} s", 10.0 * args.seconds));
    let figures = measure(&setup, level, threads, Duration::from_secs_f64(args.seconds))?;
    let text = if args.json { serde_json::to_string_pretty(&figures)? } else { table(&figures) };
    super::print(&text)?;
    Ok(Outcome::Done)
}

fn table(figures: &Figures) -> String {
    let row = |name: &str, rate: Rate| {
        let [one, all] = [rate.one_thread, rate.all_threads].map(|rate| rate / 1e6);
        format!("{name:<14}{one:>12.2}{all:>14.2}   M steps/s\n")
    };
    let threads = match figures.threads {
        1 => "1 thread".into(),
        threads => format!("{threads} threads"),
    };
    format!(
        "{:<14}{:>12}{threads:>14}   {}\n{}{}{}{}{:<14}{:>26.1}   GFLOP/s\ntraining reaches {:.0} % of the peak",
        "",
        "1 thread",
        figures.simd,
        row("physics", figures.physics_steps_per_s),
        row("environment", figures.environment_steps_per_s),
        row("rollout", figures.rollout_steps_per_s),
        row("training", figures.training_steps_per_s),
        "peak",
        figures.peak_flops_per_s / 1e9,
        100.0 * figures.training_peak_share
    )
}
