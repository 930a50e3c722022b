//! A training from its set-up to a filled run folder: trained, every snapshot evaluated, the best kept and drawn.

mod choose;
mod record;
mod resume;
pub mod room;

pub use choose::evaluate;
pub use record::told;
pub use resume::resume;

use super::run::checkpoints::{Checkpoints, ResumePoint, Taken};
use super::run::evaluated::Evaluated;
use super::run::metrics::LogRow;
use super::run::provenance::Provenance;
use super::run::{Run, SNAPSHOTS, resolved};
use crate::base::encode;
use crate::base::error::{Error, Result};
use crate::base::lane::Level;
use crate::base::threads;
use crate::learn::ppo::state::Setback;
use crate::learn::ppo::train::Iteration;
use crate::race::config::Setup;
use crate::race::env::tally::RaceTally;
use crate::race::snapshot::Snapshot;
use crate::race::train::{TrainedPolicies, train};
use record::TrainingRecorder;

/// Who watches a training, and may end it.
pub trait TrainingWatch: Send {
    /// It begins in the folder of `run`.
    fn begin(&mut self, _run: &Run, _setup: &Setup, _made: &Provenance) {}
    /// An iteration is done; `row` is what the log says of it.
    fn iteration(&mut self, _iteration: &Iteration<RaceTally>, _row: &LogRow) {}
    /// Something that whoever trains should know, in a line.
    fn remark(&mut self, _text: &str) {}
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
    let provenance = Provenance::now(Level::best(), threads);
    run.write("command.txt", format!("{command}\n"))?;
    for (name, content) in resolved::files(setup)? {
        run.write(name, content)?;
    }
    run.write("provenance.json", encode::json("the provenance", &provenance)?)?;
    let checkpoints = Checkpoints::claim(run, setup)?;
    watch.begin(run, setup, &provenance);
    go_on(run, setup, threads, checkpoints, ResumePoint::default(), watch)
}

/// Trains from what was `found` to the end.
fn go_on(
    run: &Run,
    setup: &Setup,
    threads: usize,
    checkpoints: Checkpoints,
    found: ResumePoint,
    watch: &mut dyn TrainingWatch,
) -> Result<Ended> {
    let ResumePoint { state, note, .. } = found;
    let seconds = state.as_ref().map_or(0.0, |state| state.seconds);
    let ended = threads::on(Some(threads), || {
        let mut recorder = TrainingRecorder::new(run, setup, &checkpoints, note, seconds, watch)?;
        let trained = train(Level::best(), setup, state.as_ref(), &mut recorder);
        let TrainingRecorder { failed, taken, watch, .. } = recorder;
        match (failed, &trained.diverged) {
            (Some(error), _) => return Err(unwritten(run, &taken, error)),
            (_, Some(setback)) => return Err(diverged(run, setback)),
            _ => {}
        }
        let TrainedPolicies { steps, seconds, stopped, .. } = trained;
        if stopped {
            return Ok(Ended::Stopped { steps });
        }
        choose::choose(run, setup, Level::best(), &taken, Taken { steps, seconds }, watch)
    })??;
    if let Ended::Finished(_) = ended {
        checkpoints.remove();
    }
    Ok(ended)
}

/// The end of a training that could not write.
fn unwritten(run: &Run, taken: &[Taken], error: Error) -> Error {
    let folder = run.folder.display();
    let safe = match taken.last() {
        Some(Taken { steps, .. }) => format!("The policy after {:.1} M steps is safe", *steps as f64 / 1e6),
        None => "No policy was taken before".into(),
    };
    Error::Failed(format!("{error}\n{safe}. When it can be written to again: racer train --resume {folder}"))
}

/// The end of a training whose numbers are not finite, whatever its rate.
fn diverged(run: &Run, setback: &Setback) -> Error {
    let (folder, told) = (run.folder.display(), told(setback));
    Error::Failed(format!(
        "the training diverges: {told}\nThe last policy that is whole is in {folder}/{SNAPSHOTS}; none was chosen.\n\
         Lower ppo.learning_rate or ppo.value_coefficient, or what is out of proportion in env.reward, env.noise or \
         the vehicle."
    ))
}

/// Name of a policy's file in its run folder, by its environment steps: names are in the order of training.
fn file_of(steps: u64) -> String {
    format!("{SNAPSHOTS}/{steps:013}.safetensors")
}
