//! A training as the terminal shows it, for every command that trains.

use super::progress::{TrainingBar, TrainingStatus, clock};
use super::{interrupt, table, tell};
use crate::base::error::{Error, Result};
use crate::learn::ppo::train::Iteration;
use crate::present::report::figures::{LAP, TRAINING};
use crate::present::run::metrics::LogRow;
use crate::present::run::provenance::Provenance;
use crate::present::run::{POLICY, Run};
use crate::present::train::{Finished, TrainingWatch};
use crate::race::config::Setup;
use crate::race::env::tally::RaceTally;

/// Shows the progress, and ends the training at Ctrl-C.
#[derive(Default)]
pub struct ShownTraining {
    progress: Option<TrainingBar>,
    /// The last return and number of gates there were.
    last: [Option<f64>; 2],
}

impl ShownTraining {
    /// From now on Ctrl-C ends a training after the update under way.
    pub fn new() -> Self {
        interrupt::watch("Finishing this update and saving; Ctrl-C again ends at once, without saving.");
        Self::default()
    }
}

impl TrainingWatch for ShownTraining {
    fn begin(&mut self, run: &Run, setup: &Setup, made: &Provenance) {
        let (track, folder) = (&setup.track.name, run.folder.display());
        tell(&format!("{track} on {} threads, {}; run folder {folder}", made.threads, made.simd));
        *self = Self { progress: Some(TrainingBar::new()), last: [None; 2] };
    }

    fn iteration(&mut self, iteration: &Iteration<RaceTally>, row: &LogRow) {
        let now = [row.get("episode/return_median"), row.get("episode/gates")];
        self.last = [now[0].or(self.last[0]), now[1].or(self.last[1])];
        let [episode_return, gates] = self.last;
        let &Iteration { share, seconds, steps, .. } = iteration;
        if let Some(progress) = &mut self.progress {
            progress.show(&TrainingStatus { share, seconds, steps, episode_return, gates });
        }
    }

    fn remark(&mut self, text: &str) {
        match &self.progress {
            Some(progress) => progress.say(text),
            None => tell(text),
        }
    }

    fn evaluating(&mut self, snapshots: usize) {
        self.progress = None;
        tell(&format!("evaluating {snapshots} snapshots"));
    }

    fn finished(&mut self, finished: &Finished) -> Result<()> {
        super::print(&text(finished)).map_err(Error::write("standard output".as_ref()))
    }

    fn stop(&self) -> bool {
        interrupt::asked()
    }
}

/// How a training went.
fn text(finished: &Finished) -> String {
    let folder = finished.run.folder.display();
    let (million, seconds) = (finished.steps as f64 / 1e6, finished.seconds);
    format!(
        "trained {million:.1} M steps in {} at {:.2} M steps/s; best of {} snapshots after {:.1} M steps\n\n{}\n\n\
         policy    {folder}/{POLICY}\nfigures   {folder}/{LAP}, {folder}/{TRAINING}\nevaluate  racer eval {folder}",
        clock(seconds),
        million / seconds.max(1e-9),
        finished.snapshots,
        finished.evaluated.steps as f64 / 1e6,
        table::report(&finished.evaluated.report),
    )
}
