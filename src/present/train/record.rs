//! A training as it is written down: rows, policies and checkpoints as they come.

use super::{TrainingWatch, file_of};
use crate::base::encode;
use crate::base::error::{Error, Result};
use crate::base::fsio;
use crate::learn::ppo::state::{Setback, rate_after};
use crate::learn::ppo::train::{Flow, Iteration, NetworkSnapshot, Observer};
use crate::present::run::checkpoints::{Checkpoints, Note, Taken};
use crate::present::run::health::Watched;
use crate::present::run::live::{LiveLogs, LogLengths};
use crate::present::run::metrics::LogRow;
use crate::present::run::{DIVERGED, Run};
use crate::race::checkpoint::RaceState;
use crate::race::config::Setup;
use crate::race::env::Race;
use crate::race::env::tally::RaceTally;
use crate::race::train::policy_of;

/// Writes down what it observes.
pub struct TrainingRecorder<'a> {
    pub run: &'a Run,
    pub setup: &'a Setup,
    pub watch: &'a mut dyn TrainingWatch,
    /// The first failure to write, which ends the training.
    pub failed: Option<Error>,
    /// Policies taken.
    pub taken: Vec<Taken>,
    checkpoints: &'a Checkpoints,
    logs: LiveLogs,
    /// Length of the logs at the last checkpoint, and policies taken then.
    kept: (LogLengths, usize),
    last_s: f64,
    health: Watched,
    setbacks: Vec<Setback>,
}

impl<'a> TrainingRecorder<'a> {
    /// Goes on from where `note` was made.
    pub fn new(
        run: &'a Run,
        setup: &'a Setup,
        checkpoints: &'a Checkpoints,
        note: Note,
        seconds: f64,
        watch: &'a mut dyn TrainingWatch,
    ) -> Result<Self> {
        let mut logs = LiveLogs::open(run)?;
        logs.cut(note.logs)?;
        let kept = (note.logs, note.taken.len());
        let (failed, health, setbacks) = (None, Watched::default(), Vec::new());
        Ok(Self {
            run,
            setup,
            watch,
            failed,
            taken: note.taken,
            checkpoints,
            logs,
            kept,
            last_s: seconds,
            health,
            setbacks,
        })
    }

    fn note<T>(&mut self, done: Result<T>) -> Option<T> {
        done.map_err(|error| self.failed.get_or_insert(error)).ok()
    }

    fn keep(&mut self, state: &RaceState) -> Result<()> {
        // What a checkpoint counts on is on disk before it.
        self.logs.sync()?;
        let taken = &self.taken[..state.snapshots];
        self.checkpoints.keep(state, self.logs.lengths(), taken)?;
        self.kept = (self.logs.lengths(), taken.len());
        Ok(())
    }

    fn take(&mut self, taken: &NetworkSnapshot) -> Result<()> {
        let policy = policy_of(self.setup, taken);
        let path = self.run.folder.join(file_of(taken.steps));
        fsio::replace(&path, &policy.checked_bytes()?).map_err(Error::write(&path))?;
        self.taken.push(Taken { steps: taken.steps, seconds: taken.seconds });
        Ok(())
    }

    fn go_back(&mut self) -> Result<()> {
        let (lengths, taken) = self.kept;
        self.taken.truncate(taken);
        self.logs.cut(lengths)?;
        let path = self.run.folder.join(DIVERGED);
        let all: Vec<_> = self.setbacks.iter().map(told).collect();
        fsio::replace(&path, encode::json("the setbacks", &all)?.as_bytes()).map_err(Error::write(&path))
    }
}

/// A setback in a sentence.
pub fn told(setback: &Setback) -> String {
    let &Setback { what, steps, back_to, times, .. } = setback;
    let million = |steps: u64| steps as f64 / 1e6;
    let found = format!("{what} was not finite after {:.2} M steps", million(steps));
    match setback.is_last() {
        true => format!("{found}, at {:.3} of the configured learning rate", rate_after(times - 1)),
        false => {
            format!("{found}; back to {:.2} M, at {:.3} of the learning rate", million(back_to), rate_after(times))
        }
    }
}

impl Observer<Race> for TrainingRecorder<'_> {
    fn iteration(&mut self, iteration: &Iteration<RaceTally>) -> Flow {
        if self.failed.is_some() {
            return Flow::Stop;
        }
        let row = LogRow::new(iteration, iteration.seconds - self.last_s);
        self.last_s = iteration.seconds;
        let added = self.logs.append(&row);
        self.note(added);
        self.watch.iteration(iteration, &row);
        for warning in self.health.after(&row, iteration.share) {
            self.watch.remark(&warning);
        }
        if self.failed.is_some() || self.watch.stop() { Flow::Stop } else { Flow::Continue }
    }

    fn snapshot(&mut self, taken: &NetworkSnapshot) {
        if self.failed.is_none() {
            let done = self.take(taken);
            self.note(done);
        }
    }

    fn checkpoint(&mut self, state: &RaceState) {
        if self.failed.is_none() {
            let done = self.keep(state);
            self.note(done);
        }
    }

    fn setback(&mut self, setback: &Setback) {
        self.watch.remark(&format!("warning: {}", told(setback)));
        self.setbacks.push(setback.clone());
        let done = self.go_back();
        self.note(done);
    }
}
