//! `racer train`: a policy from a track.

use super::pool::{pool, threads};
use super::progress::{Progress, Status, clock};
use super::{Outcome, interrupt, table, tell};
use crate::base::check::BadInput;
use crate::base::lane::Level;
use crate::learn::ppo::train::{Flow, Iteration, Observer, Trained, train};
use crate::present::report::figures::{self, LAP, TRAINING};
use crate::present::run::evaluated::{self, EVALUATED, Evaluated};
use crate::present::run::metrics::{METRICS, Row, to_csv};
use crate::present::run::provenance::Provenance;
use crate::present::run::{POLICY, Run, SNAPSHOTS, TENSORBOARD, resolved, tensorboard};
use crate::race::config::{DEFAULT, Setting, Setup};
use crate::race::env::Race;
use crate::race::env::reset::Place;
use crate::race::env::tally::Tally;
use crate::race::eval::{Report, benchmark};
use crate::race::snapshot::{About, Snapshot};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

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
    #[arg(long, value_parser = super::pool::parse_threads)]
    threads: Option<usize>,
    /// New folder for the run [default: one below runs/, named by time and track]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// End at once, without saving, when standard input ends: how a study takes its trainings along
    #[arg(long, hide = true)]
    attached: bool,
}

const HELP: &str =
    "A file needs only the keys that differ from the built-in a2rl.toml. Ctrl-C finishes the update and saves.

Examples:
  racer train
  racer train --track uzh_split_s --minutes 2 --set ppo.learning_rate=3e-4
  racer train --config runs/RUN/config.toml --seed 2";

/// The help with all keys of the configuration.
fn long_help() -> String {
    format!("{HELP}\n\nThe built-in a2rl.toml:\n\n{}", include_str!("../../configs/a2rl.toml"))
}

impl Args {
    /// Training in the vehicle of a file, into a new folder, with everything else as built in.
    pub fn in_vehicle(vehicle: &Path, minutes: f64, out: &Path) -> Self {
        Args {
            config: DEFAULT.into(),
            track: None,
            vehicle: Some(vehicle.display().to_string()),
            set: Vec::new(),
            seed: None,
            minutes: Some(minutes),
            steps: None,
            threads: None,
            out: Some(out.into()),
            attached: false,
        }
    }

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
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let setup = Setup::load(&args.config, &args.settings()?)?;
    let (level, threads) = (Level::best(), threads(args.threads));
    let run = Run::create(args.out.as_deref(), &setup.track.name)?;
    begin(&run, &setup, &Provenance::now(level, threads))?;
    interrupt::watch("Finishing this update and saving; Ctrl-C again ends at once, without saving.")?;
    if args.attached {
        interrupt::end_with_standard_input();
    }
    let Setup { config, track, vehicle } = &setup;
    tell(&format!("{} on {threads} threads, {level}; run folder {}", track.name, run.folder.display()));

    pool(threads)?.install(|| {
        let race = Race::new(&config.env, track, vehicle, config.seed);
        let started = SystemTime::now();
        let mut log = Log { rows: Vec::new(), last_s: 0.0, progress: Progress::new(), shown: (None, None) };
        let trained = train(level, &race, &config.ppo, &config.budget, config.seed, &mut log);
        log.progress.finish();
        let policies = save(&run, &setup, &trained, started, &log.rows)?;
        if trained.stopped {
            return stopped(&run, &trained);
        }
        evaluate(&run, &setup, level, &race, &trained, &policies, &log.rows)
    })
}

/// Writes what is known before the training.
fn begin(run: &Run, setup: &Setup, provenance: &Provenance) -> anyhow::Result<()> {
    let quoted = std::env::args_os().map(|word| quote(&word.to_string_lossy())).collect::<Vec<_>>().join(" ");
    run.write("command.txt", quoted + "\n")?;
    for (name, content) in resolved::files(setup)? {
        run.write(name, content)?;
    }
    run.write("provenance.json", serde_json::to_string_pretty(provenance)? + "\n")?;
    Ok(())
}

/// A word as a shell reads it back.
fn quote(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=./:,+".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

/// Gathers the log and shows the progress. Writing waits until the training is over: it is not part of the budget.
struct Log {
    rows: Vec<Row>,
    last_s: f64,
    progress: Progress,
    /// The last return and number of gates there were.
    shown: (Option<f64>, Option<f64>),
}

impl Observer<Tally> for Log {
    fn iteration(&mut self, iteration: &Iteration<Tally>) -> Flow {
        let row = Row::new(iteration, iteration.seconds - self.last_s);
        self.last_s = iteration.seconds;
        let (episode_return, gates) = (row.get("episode/return_median"), row.get("episode/gates"));
        self.shown = (episode_return.or(self.shown.0), gates.or(self.shown.1));
        self.rows.push(row);
        let &Iteration { share, seconds, steps, .. } = iteration;
        self.progress.show(&Status { share, seconds, steps, episode_return: self.shown.0, gates: self.shown.1 });
        if interrupt::asked() { Flow::Stop } else { Flow::Continue }
    }
}

/// Writes snapshots and logs; returns the policies with the names of their files.
fn save(
    run: &Run,
    setup: &Setup,
    trained: &Trained,
    started: SystemTime,
    rows: &[Row],
) -> anyhow::Result<Vec<(String, Snapshot)>> {
    let Setup { config, track, vehicle } = setup;
    let mut policies = Vec::new();
    for snapshot in &trained.snapshots {
        let name = format!("{SNAPSHOTS}/{:013}.safetensors", snapshot.steps);
        let about = About {
            track: track.clone(),
            vehicle: vehicle.clone(),
            env: config.env.clone(),
            eval: config.eval.clone(),
            seed: config.seed,
            steps: snapshot.steps,
            seconds: snapshot.seconds,
        };
        let policy = Snapshot { network: snapshot.network.clone(), about };
        run.write(&name, policy.to_bytes()?)?;
        policies.push((name, policy));
    }
    run.write(METRICS, to_csv(rows)?)?;
    run.write(&format!("{TENSORBOARD}/{}", tensorboard::file_name(started)), tensorboard::events(started, rows))?;
    Ok(policies)
}

fn stopped(run: &Run, trained: &Trained) -> anyhow::Result<Outcome> {
    let folder = run.folder.display();
    tell(&format!(
        "Stopped after {:.1} M steps; everything so far is in {folder}.\n  \
         racer eval {folder}                        evaluates the last policy\n  \
         racer train --config {folder}/config.toml  trains again, to the end",
        trained.steps as f64 / 1e6
    ));
    Ok(Outcome::Interrupted)
}

/// Benchmarks all snapshots, keeps the best.
fn evaluate(
    run: &Run,
    setup: &Setup,
    level: Level,
    race: &Race,
    trained: &Trained,
    policies: &[(String, Snapshot)],
    rows: &[Row],
) -> anyhow::Result<Outcome> {
    tell(&format!("evaluating {} snapshots", policies.len()));
    let (mut reports, mut traces) = (Vec::new(), Vec::new());
    for (_, policy) in policies {
        if interrupt::asked() {
            return stopped(run, trained);
        }
        let fly = |place| benchmark(level, race, &setup.track, &policy.network, place, &setup.config.eval);
        let (fixed, flights) = fly(Place::Pad);
        reports.push(Report { fixed: Some(fixed), random: Some(fly(Place::Spline).0) });
        traces.push(flights.trace);
    }
    let entries = policies.iter().zip(&reports).map(|((name, policy), report)| {
        let &About { steps, seconds, .. } = &policy.about;
        let penalty = setup.config.ppo.penalty(setup.config.budget.share(steps, seconds));
        Evaluated { snapshot: name.clone(), steps, seconds, penalty, report: report.clone() }
    });
    let entries: Vec<_> = entries.collect();
    run.write(EVALUATED, serde_json::to_string_pretty(&entries)? + "\n")?;
    let Some(best) = evaluated::best(&entries) else { anyhow::bail!("the training took no snapshot") };
    let chosen = entries.iter().position(|e| e.snapshot == best.snapshot).expect("one of them");
    run.write(POLICY, policies[chosen].1.to_bytes()?)?;
    run.write("evaluation.json", serde_json::to_string_pretty(&entries[chosen])? + "\n")?;

    figures::write_lap(run, &setup.track, &traces[chosen], &reports[chosen])?;
    let title = format!("{}, seed {}", setup.track.name, setup.config.seed);
    let curve: Vec<_> = rows.iter().map(|row| [row.get("time/seconds"), row.get("episode/gates")]).collect();
    run.write(TRAINING, figures::training(&title, &curve, &entries, &entries[chosen].snapshot)?)?;

    let folder = run.folder.display();
    let (million, seconds) = (trained.steps as f64 / 1e6, trained.seconds);
    super::print(&format!(
        "trained {million:.1} M steps in {} at {:.2} M steps/s; best of {} snapshots after {:.1} M steps\n\n{}\n\n\
         policy    {folder}/{POLICY}\nfigures   {folder}/{LAP}, {folder}/{TRAINING}\nevaluate  racer eval {folder}",
        clock(seconds),
        million / seconds.max(1e-9),
        policies.len(),
        policies[chosen].1.about.steps as f64 / 1e6,
        table::report(&reports[chosen]),
    ))?;
    Ok(Outcome::Done)
}
