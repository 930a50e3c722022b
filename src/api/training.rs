//! Training with an observer: in memory, or into a run folder.

use super::policy::Policy;
use crate::base::error::{Error, Result};
use crate::base::lane::Level;
use crate::base::threads;
use crate::learn::ppo::train::{Flow, Iteration, Observer};
use crate::present::run::Run;
use crate::present::run::evaluated;
use crate::present::run::metrics::LogRow;
use crate::present::train::{Ended, TrainingWatch, evaluate, make, room, told};
use crate::race::config::Setup;
use crate::race::env::Race;
use crate::race::env::tally::RaceTally;
use crate::race::eval::Report;
use crate::race::train;
use std::path::Path;

/// How far a training is.
#[derive(Clone, Debug)]
pub struct Progress {
    /// Share of the budget used, 0 to 1.
    pub share: f64,
    /// Updates done.
    pub updates: usize,
    /// Environment steps done.
    pub steps: u64,
    /// Time since the training began, s.
    pub seconds: f64,
    row: LogRow,
}

impl Progress {
    fn new(iteration: &Iteration<RaceTally>, row: LogRow) -> Self {
        let &Iteration { index, share, steps, seconds, .. } = iteration;
        Self { share, updates: index, steps, seconds, row }
    }

    /// A number of the last update by its name in `metrics.csv`, such as `episode/gates`; none where there was nothing
    /// to average over.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.row.get(name)
    }

    /// Names of all metrics.
    pub fn metrics(&self) -> impl Iterator<Item = &str> {
        self.row.values.iter().map(|(name, _)| name.as_str())
    }
}

/// What a training leaves.
#[derive(Clone, Debug)]
pub struct Trained {
    /// Evenly spread over the budget; the last is the final policy.
    pub policies: Vec<Policy>,
    /// Environment steps done.
    pub steps: u64,
    /// Time that they took, s.
    pub seconds: f64,
    /// Whether the observer ended it before the budget did.
    pub stopped: bool,
    setup: Setup,
}

impl Trained {
    /// Evaluates every policy as the set-up says, and returns the best with its score: the one with which most vehicles
    /// complete a lap from the pad, of equals the fastest. Policies from a time when penalties were not yet whole do
    /// not count.
    pub fn best(&self) -> Result<(Policy, Report)> {
        let policies: Vec<_> = self.policies.iter().map(|policy| (policy.0.clone(), policy.0.about.seconds)).collect();
        let flown = threads::on(None, || evaluate(Level::best(), &self.setup, &policies, &mut || false))?;
        let all: Vec<_> = flown.unwrap_or_default().into_iter().map(|(evaluated, _)| evaluated).collect();
        let best = evaluated::best(&all).map(|best| &best.snapshot);
        let place = all.iter().position(|e| Some(&e.snapshot) == best);
        let place = place.ok_or_else(|| Error::Failed("the training took no snapshot".into()))?;
        Ok((self.policies[place].clone(), all[place].report.clone()))
    }
}

/// Watches by a closure.
struct Closure<F> {
    observer: F,
    last_s: f64,
    flow: Flow,
}

impl<F: FnMut(&Progress) -> Flow> Closure<F> {
    fn new(observer: F) -> Self {
        Self { observer, last_s: 0.0, flow: Flow::Continue }
    }
}

impl<F: FnMut(&Progress) -> Flow> Observer<Race> for Closure<F> {
    fn iteration(&mut self, iteration: &Iteration<RaceTally>) -> Flow {
        let row = LogRow::new(iteration, iteration.seconds - self.last_s);
        self.last_s = iteration.seconds;
        (self.observer)(&Progress::new(iteration, row))
    }
}

impl<F: FnMut(&Progress) -> Flow + Send> TrainingWatch for Closure<F> {
    fn iteration(&mut self, iteration: &Iteration<RaceTally>, row: &LogRow) {
        self.flow = (self.observer)(&Progress::new(iteration, row.clone()));
    }

    fn stop(&self) -> bool {
        self.flow == Flow::Stop
    }
}

/// Trains a policy as `setup` says, on all processors. `observer` is called after every update and says whether to go
/// on. The same set-up with a budget of steps gives the same policies bit for bit, on any number of threads.
pub fn train(setup: &Setup, observer: impl FnMut(&Progress) -> Flow + Send) -> Result<Trained> {
    room::check(setup)?;
    let trained = threads::on(None, || train::train(Level::best(), setup, None, &mut Closure::new(observer)))?;
    let train::TrainedPolicies { policies, steps, seconds, stopped, diverged } = trained;
    if let Some(setback) = diverged {
        return Err(Error::Failed(format!("the training diverges: {}", told(&setback))));
    }
    let policies = policies.into_iter().map(Policy).collect();
    Ok(Trained { policies, steps, seconds, stopped, setup: setup.clone() })
}

/// [`train`] into the new or empty folder `out`: configuration, learning curves, every policy on the way, its
/// evaluation, and the best policy with figures, as `racer train` does. Returns the best and its score.
/// [`Error::Interrupted`] where the observer ends it; what was trained is in the folder then.
pub fn train_into(
    out: impl AsRef<Path>,
    setup: &Setup,
    observer: impl FnMut(&Progress) -> Flow + Send,
) -> Result<(Policy, Report)> {
    room::check(setup)?;
    let run = Run::create(Some(out.as_ref()), &setup.track.name)?;
    match make(&run, setup, threads::processors(), "racer::train_into", &mut Closure::new(observer))? {
        Ended::Finished(finished) => Ok((Policy(finished.policy), finished.evaluated.report)),
        Ended::Stopped { steps } => {
            let (million, folder) = (steps as f64 / 1e6, run.folder.display());
            Err(Error::Interrupted(format!("Stopped after {million:.1} M steps; everything so far is in {folder}.")))
        }
    }
}
