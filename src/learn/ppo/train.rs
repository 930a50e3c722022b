//! The training loop: iterations, policies taken on the way, states to go on from, setbacks.

use super::Environment;
use super::config::{BudgetConfig, PpoConfig};
use super::state::{MOST_SETBACKS, Setback, TrainingState, not_finite};
use super::training::{Learnt, Training};
use super::update::Losses;
use crate::base::lane::Level;
use crate::learn::nn::Network;
use std::time::Instant;

/// What one iteration did.
pub struct Iteration<'a, T> {
    /// Iterations done, this one included.
    pub index: usize,
    /// Environment steps done.
    pub steps: u64,
    /// Seconds since the first training call.
    pub seconds: f64,
    /// Share of the budget used, 0..1.
    pub share: f64,
    /// Environment steps of one iteration.
    pub batch: usize,
    pub learning_rate: f64,
    pub losses: Losses,
    /// Share of the returns' variance that the critic explains.
    pub explained_variance: f64,
    /// Standard deviation of the advantages before they are normalised.
    pub advantage_std: f64,
    /// Standard deviation of the exploration noise, mean over the commands.
    pub std: f64,
    pub tally: &'a T,
}

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// End with what there is.
    Stop,
}

/// Watches a training; the trainer itself touches neither disk nor terminal.
pub trait Observer<E: Environment> {
    /// An iteration is done.
    fn iteration(&mut self, iteration: &Iteration<E::Tally>) -> Flow;
    /// A policy was taken.
    fn snapshot(&mut self, _taken: &NetworkSnapshot) {}
    /// The training could go on from `state`, in which the policies taken so far are counted. A policy that is taken
    /// because the observer ended the training comes after it, and does not count.
    fn checkpoint(&mut self, _state: &TrainingState<E::Saved>) {}
    /// A number was not finite: the training goes back to the last checkpoint, or ends.
    fn setback(&mut self, _setback: &Setback) {}
}

/// A policy on the way.
#[derive(Clone)]
pub struct NetworkSnapshot {
    pub network: Network<f32>,
    pub steps: u64,
    pub seconds: f64,
}

/// What a training leaves.
pub struct TrainedNetworks {
    /// Evenly spread over the budget; the last is the final policy.
    pub snapshots: Vec<NetworkSnapshot>,
    pub steps: u64,
    pub seconds: f64,
    /// Whether the observer ended it before the budget did.
    pub stopped: bool,
    /// What ended it before either, in spite of setbacks. The last policy is then the last finite one.
    pub diverged: Option<Setback>,
}

/// Trains under `budget` on the current rayon pool, from the beginning or from `state`. The clock starts with the first
/// iteration and includes rollouts and updates (paper section 5.1); it stands still while the observer keeps what it is
/// given to keep.
pub fn train<E: Environment>(
    level: Level,
    environment: &E,
    config: &PpoConfig,
    budget: &BudgetConfig,
    seed: u64,
    state: Option<&TrainingState<E::Saved>>,
    observer: &mut dyn Observer<E>,
) -> TrainedNetworks {
    let mut training = Training::new(level, environment, config, seed);
    if let Some(state) = state {
        training.restore(state);
    }
    let (before_s, before) = state.map_or((0.0, 0), |state| (state.seconds, state.snapshots));
    let mut clock = Clock { before_s, started: Instant::now(), paused_s: 0.0 };
    let mut kept = training.state(before, before_s);
    let mut snapshots = Vec::new();
    let mut end = (budget.share(training.steps(), before_s) >= 1.0).then_some(Flow::Continue);
    while end.is_none() {
        let learnt = training.iterate(budget.share(training.steps(), clock.seconds()));
        if let Some(what) = not_finite(&learnt.losses, training.network(), training.adam()) {
            let times = kept.setbacks + 1;
            let setback = Setback { what, steps: training.steps(), back_to: kept.steps, times };
            observer.setback(&setback);
            snapshots.truncate(kept.snapshots - before);
            if times > MOST_SETBACKS {
                training.restore(&kept);
                if kept.snapshots == 0 {
                    take(&training, clock.seconds(), &mut snapshots, observer);
                }
                let (steps, seconds) = (training.steps(), clock.seconds());
                return TrainedNetworks { snapshots, steps, seconds, stopped: false, diverged: Some(setback) };
            }
            kept.setbacks = times;
            training.restore(&kept);
            continue;
        }
        let seconds = clock.seconds();
        let share = budget.share(training.steps(), seconds);
        let flow = report(&training, &learnt, share, seconds, observer);
        let due = share >= 1.0 || share * budget.snapshots as f64 >= (before + snapshots.len() + 1) as f64;
        clock.pause(|| {
            if due {
                take(&training, seconds, &mut snapshots, observer);
            }
            if due || flow == Flow::Stop {
                kept = training.state(before + snapshots.len(), seconds);
                observer.checkpoint(&kept);
            }
            if flow == Flow::Stop && !due {
                take(&training, seconds, &mut snapshots, observer);
            }
        });
        end = (share >= 1.0 || flow == Flow::Stop).then_some(if share >= 1.0 { Flow::Continue } else { flow });
    }
    let (steps, stopped) = (training.steps(), end == Some(Flow::Stop));
    TrainedNetworks { snapshots, steps, seconds: clock.seconds(), stopped, diverged: None }
}

/// Time of the budget used.
struct Clock {
    before_s: f64,
    started: Instant,
    paused_s: f64,
}

impl Clock {
    fn seconds(&self) -> f64 {
        self.before_s + self.started.elapsed().as_secs_f64() - self.paused_s
    }

    /// Does `work` beside the budget.
    fn pause(&mut self, work: impl FnOnce()) {
        let begin = Instant::now();
        work();
        self.paused_s += begin.elapsed().as_secs_f64();
    }
}

/// Takes a policy.
fn take<E: Environment>(
    training: &Training<E>,
    seconds: f64,
    snapshots: &mut Vec<NetworkSnapshot>,
    observer: &mut dyn Observer<E>,
) {
    let taken = NetworkSnapshot { network: training.average().clone(), steps: training.steps(), seconds };
    observer.snapshot(&taken);
    snapshots.push(taken);
}

/// Tells `observer` of an iteration.
fn report<E: Environment>(
    training: &Training<E>,
    learnt: &Learnt,
    share: f64,
    seconds: f64,
    observer: &mut dyn Observer<E>,
) -> Flow {
    let tally = training.tally();
    observer.iteration(&Iteration {
        index: training.iterations(),
        steps: training.steps(),
        seconds,
        share,
        batch: training.batch(),
        learning_rate: learnt.learning_rate,
        losses: learnt.losses,
        explained_variance: learnt.explained_variance,
        advantage_std: learnt.advantage_std,
        std: training.network().log_std().iter().map(|s| s.exp() as f64).sum::<f64>() / 4.0,
        tally: &tally,
    })
}
