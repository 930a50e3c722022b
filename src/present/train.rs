//! A training from its set-up to a filled run folder: trained, every snapshot evaluated, the best kept and drawn.

use super::report::figures::{self, TRAINING};
use super::run::evaluated::{self, EVALUATED, Evaluated};
use super::run::metrics::{LogRow, METRICS, to_csv};
use super::run::provenance::Provenance;
use super::run::{POLICY, Run, SNAPSHOTS, TENSORBOARD, resolved, tensorboard};
use crate::base::encode;
use crate::base::error::{Error, Result};
use crate::base::lane::Level;
use crate::base::threads;
use crate::learn::ppo::train::{Flow, Iteration, Observer};
use crate::race::config::Setup;
use crate::race::env::tally::Tally;
use crate::race::eval::both_starts;
use crate::race::eval::fly::TraceStep;
use crate::race::snapshot::Snapshot;
use crate::race::train::{TrainedPolicies, train};
use std::time::SystemTime;

/// Who watches a training, and may end it.
pub trait TrainingWatch: Send {
    /// It begins in the folder of `run`.
    fn begin(&mut self, _run: &Run, _setup: &Setup, _made: &Provenance) {}
    /// An iteration is done; `row` is what the log says of it.
    fn iteration(&mut self, _iteration: &Iteration<Tally>, _row: &LogRow) {}
    /// So many snapshots are about to be evaluated.
    fn evaluating(&mut self, _snapshots: usize) {}
    /// It is done, and everything is written.
    fn finished(&mut self, _finished: &Finished) -> Result<()> {
        Ok(())
    }
    /// Whether to come to an end: asked after every iteration and before every evaluation.
    fn stop(&self) -> bool {
        false
    }
}

/// A finished training.
#[derive(Clone, Debug)]
pub struct Finished {
    pub run: Run,
    /// Environment steps and time, s, of the training.
    pub steps: u64,
    pub seconds: f64,
    /// Policies that were evaluated.
    pub snapshots: usize,
    /// The best of them, and how it did.
    pub policy: Snapshot,
    pub evaluated: Evaluated,
}

/// How a training ended.
#[derive(Clone, Debug)]
pub enum Ended {
    Finished(Box<Finished>),
    /// Whoever watched asked for it after so many steps. What was trained is in the run folder, and nothing is chosen.
    Stopped {
        steps: u64,
    },
}

/// Trains as `setup` says and fills the folder of `run`, on so many threads; `command` is how the user asked for it.
pub fn make(run: &Run, setup: &Setup, threads: usize, command: &str, watch: &mut dyn TrainingWatch) -> Result<Ended> {
    let (level, provenance) = (Level::best(), Provenance::now(Level::best(), threads));
    run.write("command.txt", format!("{command}\n"))?;
    for (name, content) in resolved::files(setup)? {
        run.write(name, content)?;
    }
    run.write("provenance.json", encode::json("the provenance", &provenance)?)?;
    watch.begin(run, setup, &provenance);
    threads::on(Some(threads), || {
        let mut log = RowLog { rows: Vec::new(), last_s: 0.0, watch };
        let started = SystemTime::now();
        let trained = train(level, setup, &mut log);
        let RowLog { rows, watch, .. } = log;
        save(run, &trained, started, &rows)?;
        if trained.stopped {
            return Ok(Ended::Stopped { steps: trained.steps });
        }
        choose(run, setup, level, &trained, &rows, watch)
    })?
}

/// Gathers the rows of the log. Writing waits until the training is over: it is not part of the budget.
struct RowLog<'a> {
    rows: Vec<LogRow>,
    last_s: f64,
    watch: &'a mut dyn TrainingWatch,
}

impl Observer<Tally> for RowLog<'_> {
    fn iteration(&mut self, iteration: &Iteration<Tally>) -> Flow {
        let row = LogRow::new(iteration, iteration.seconds - self.last_s);
        self.last_s = iteration.seconds;
        self.watch.iteration(iteration, &row);
        self.rows.push(row);
        if self.watch.stop() { Flow::Stop } else { Flow::Continue }
    }
}

/// Name of a policy's file in its run folder: names are in the order of training.
fn file_of(policy: &Snapshot) -> String {
    format!("{SNAPSHOTS}/{:013}.safetensors", policy.about.steps)
}

/// Writes policies and logs.
fn save(run: &Run, trained: &TrainedPolicies, started: SystemTime, rows: &[LogRow]) -> Result<()> {
    for policy in &trained.policies {
        run.write(&file_of(policy), policy.to_bytes()?)?;
    }
    run.write(METRICS, to_csv(rows)?)?;
    run.write(&format!("{TENSORBOARD}/{}", tensorboard::file_name(started)), tensorboard::events(started, rows))?;
    Ok(())
}

/// Evaluates all policies, in their order, each with the nominal vehicle's flight from the pad; none where `stop` says
/// so in between.
pub fn evaluate(
    level: Level,
    setup: &Setup,
    policies: &[Snapshot],
    stop: &mut dyn FnMut() -> bool,
) -> Option<Vec<(Evaluated, Vec<TraceStep>)>> {
    let Setup { config, track, .. } = setup;
    let mut all = Vec::new();
    for policy in policies {
        if stop() {
            return None;
        }
        let (report, trace) = both_starts(level, &policy.race(None), track, &policy.network, &config.eval);
        let (steps, seconds) = (policy.about.steps, policy.about.seconds);
        let penalty = config.ppo.penalty(config.budget.share(steps, seconds));
        all.push((Evaluated { snapshot: file_of(policy), steps, seconds, penalty, report }, trace));
    }
    Some(all)
}

/// Evaluates all policies, and writes the best with its figures.
fn choose(
    run: &Run,
    setup: &Setup,
    level: Level,
    trained: &TrainedPolicies,
    rows: &[LogRow],
    watch: &mut dyn TrainingWatch,
) -> Result<Ended> {
    watch.evaluating(trained.policies.len());
    let Some(flown) = evaluate(level, setup, &trained.policies, &mut || watch.stop()) else {
        return Ok(Ended::Stopped { steps: trained.steps });
    };
    let (all, traces): (Vec<_>, Vec<_>) = flown.into_iter().unzip();
    run.write(EVALUATED, encode::json("the evaluations", &all)?)?;
    let best = evaluated::best(&all).map(|best| &best.snapshot);
    let Some(chosen) = all.iter().position(|e| Some(&e.snapshot) == best) else {
        return Err(Error::Failed("the training took no snapshot".into()));
    };
    run.write(POLICY, trained.policies[chosen].to_bytes()?)?;
    run.write("evaluation.json", encode::json("the evaluation", &all[chosen])?)?;
    figures::write_lap(run, &setup.track, &traces[chosen], &all[chosen].report)?;
    let title = format!("{}, seed {}", setup.track.name, setup.config.seed);
    let curve: Vec<_> = rows.iter().map(|row| [row.get("time/seconds"), row.get("episode/gates")]).collect();
    run.write(TRAINING, figures::training(&title, &curve, &all, &all[chosen].snapshot)?)?;

    let finished = Finished {
        run: run.clone(),
        steps: trained.steps,
        seconds: trained.seconds,
        snapshots: all.len(),
        policy: trained.policies[chosen].clone(),
        evaluated: all[chosen].clone(),
    };
    watch.finished(&finished)?;
    Ok(Ended::Finished(Box::new(finished)))
}
