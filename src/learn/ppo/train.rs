//! The training loop: rollout, advantages, update, snapshot.

use super::awake::awake;
use super::batch::Batch;
use super::config::{BudgetConfig, PpoConfig};
use super::loss::Weights;
use super::rollout::{Rollout, Tile, collect};
use super::state::{MOST_SETBACKS, Setback, TrainingState, not_finite, rate_after};
use super::update::{Hyper, Losses, Updater};
use super::{Environment, Tally as _, gae};
use crate::base::lane::Level;
use crate::base::rng::{Philox, Stream};
use crate::learn::nn::{Network, TILE_BLOCKS, TILE_SAMPLES};
use rand::seq::SliceRandom;
use rayon::prelude::*;
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

/// What an iteration computed.
pub struct Learnt {
    losses: Losses,
    explained_variance: f64,
    advantage_std: f64,
    learning_rate: f64,
}

/// A training under way: everything that an iteration reads and changes.
pub struct Training<'a, E: Environment> {
    level: Level,
    environment: &'a E,
    config: &'a PpoConfig,
    rng: Philox,
    tiles: Vec<Tile<E>>,
    rollout: Rollout,
    advantages: Vec<f32>,
    returns: Vec<f32>,
    order: Vec<u32>,
    updater: Updater<f32>,
    network: Network<f32>,
    iterations: usize,
    setbacks: u32,
}

impl<'a, E: Environment> Training<'a, E> {
    /// Fresh environments and weights.
    pub fn new(level: Level, environment: &'a E, config: &'a PpoConfig, seed: u64) -> Self {
        let n = config.environments / TILE_SAMPLES;
        let rng = Philox::new(seed);
        let network = Network::initialised(
            environment.observations(),
            config.log_std_initial,
            &mut rng.sequence(Stream::Weights, 0, 0),
        );
        let rollout = Rollout::new(n, config.rollout, environment.observations());
        let samples = config.environments * config.rollout;
        Training {
            level,
            environment,
            config,
            rng,
            tiles: (0..n).map(|i| Tile::new(environment, i)).collect(),
            advantages: vec![0.0; samples],
            returns: vec![0.0; samples],
            order: (0..(n * rollout.tile_rows) as u32).collect(),
            rollout,
            updater: Updater::new(&network),
            network,
            iterations: 0,
            setbacks: 0,
        }
    }

    /// Environment steps done.
    pub fn steps(&self) -> u64 {
        (self.iterations * self.batch()) as u64
    }

    /// What it goes on from, so many policies taken, after so many seconds.
    pub fn state(&self, snapshots: usize, seconds: f64) -> TrainingState<E::Saved> {
        TrainingState {
            iterations: self.iterations,
            steps: self.steps(),
            seconds,
            snapshots,
            setbacks: self.setbacks,
            network: self.network.clone(),
            adam: self.updater.adam.clone(),
            order: self.order.clone(),
            environments: self.tiles.iter().flat_map(Tile::saved).cloned().collect(),
        }
    }

    /// Goes on from `state`, which is one of this training.
    ///
    /// # Panics
    /// If it is of another number of environments.
    pub fn restore(&mut self, state: &TrainingState<E::Saved>) {
        self.iterations = state.iterations;
        self.setbacks = state.setbacks;
        self.network = state.network.clone();
        self.updater.adam = state.adam.clone();
        self.order.copy_from_slice(&state.order);
        let (tiles, _) = state.environments.as_chunks::<TILE_BLOCKS>();
        assert_eq!(tiles.len(), self.tiles.len(), "a state of this training");
        self.tiles.iter_mut().zip(tiles).for_each(|(tile, saved)| tile.resume(saved));
    }

    /// Environment steps of one iteration.
    pub fn batch(&self) -> usize {
        self.config.environments * self.config.rollout
    }

    /// Collects one rollout.
    pub fn collect(&mut self, environment: &E) {
        let first_step = (self.iterations * self.config.rollout) as u32;
        collect(self.level, environment, &self.network, &self.rng, &mut self.tiles, &mut self.rollout, first_step);
    }

    /// Generalised advantages of the rollout, normalised over the batch; returns the explained variance and their
    /// standard deviation before.
    fn advantages(&mut self) -> (f64, f64) {
        let (gamma, lambda) = (self.config.gamma as f32, self.config.lambda as f32);
        let lanes = self.rollout.tile_rows * crate::base::lane::LANES;
        let out = self.advantages.par_chunks_exact_mut(lanes).zip(self.returns.par_chunks_exact_mut(lanes));
        let level = self.level;
        self.rollout.tiles().into_par_iter().zip(out).for_each(|(tile, (advantages, returns))| {
            let steps = gae::Steps {
                blocks: TILE_BLOCKS,
                rewards: tile.rewards,
                values: tile.values,
                terminated: tile.terminated,
                truncated: tile.truncated,
                final_values: tile.final_values,
                last_values: tile.last_values,
            };
            gae::advantages(level, &steps, gamma, lambda, advantages, returns);
        });
        let residual = variance(&self.advantages);
        let total = variance(&self.returns);
        gae::normalise(&mut self.advantages);
        (1.0 - residual / total.max(1e-12), residual.sqrt())
    }

    /// Rollout, advantages and all epochs of one iteration at `share` of the budget.
    pub fn iterate(&mut self, share: f64) -> Learnt {
        let c = self.config;
        let penalty = c.penalty(share);
        self.collect(&self.environment.with_penalties(penalty));
        let (explained_variance, advantage_std) = self.advantages();
        let scheduled = c.learning_rate + (c.learning_rate_final - c.learning_rate) * share.clamp(0.0, 1.0);
        let learning_rate = scheduled * rate_after(self.setbacks);
        let hyper = Hyper {
            weights: Weights {
                clip: c.clip,
                entropy: c.entropy_at(share),
                squashed: c.entropy_squashed,
                magnitude: c.action_magnitude * penalty,
                value: c.value_coefficient,
            },
            learning_rate,
            max_gradient_norm: c.max_gradient_norm,
            adam_epsilon: c.adam_epsilon,
        };
        let batch = Batch {
            observations: &self.rollout.observations,
            z: &self.rollout.z,
            log_prob: &self.rollout.log_prob,
            advantages: &self.advantages,
            returns: &self.returns,
        };
        let (level, order, updater, network) = (self.level, &mut self.order, &mut self.updater, &mut self.network);
        let shuffles =
            (0..c.epochs).map(|epoch| self.rng.sequence(Stream::Shuffle, epoch as u32, self.iterations as u32));
        let losses = awake(|| {
            let mut losses = Losses::default();
            for mut shuffle in shuffles {
                order.shuffle(&mut shuffle);
                for rows in order.chunks_exact(order.len() / c.minibatches) {
                    losses = updater.step(level, network, &batch, rows, &hyper);
                }
            }
            losses
        });
        self.iterations += 1;
        Learnt { losses, explained_variance, advantage_std, learning_rate }
    }
}

/// Trains under `budget` on the current rayon pool, from the beginning or from `state`. The clock starts with the first
/// iteration and includes rollouts, updates and snapshots (paper section 5.1).
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
    let started = Instant::now();
    let clock = || before_s + started.elapsed().as_secs_f64();
    let mut kept = training.state(before, before_s);
    let mut snapshots = Vec::new();
    let mut end = (budget.share(training.steps(), before_s) >= 1.0).then_some(Flow::Continue);
    while end.is_none() {
        let learnt = training.iterate(budget.share(training.steps(), clock()));
        if let Some(what) = not_finite(&learnt.losses, &training.network, &training.updater.adam) {
            let times = kept.setbacks + 1;
            let setback = Setback { what, steps: training.steps(), back_to: kept.steps, times };
            observer.setback(&setback);
            training.restore(&kept);
            snapshots.truncate(kept.snapshots - before);
            if times > MOST_SETBACKS {
                if kept.snapshots == 0 {
                    take(&training, clock(), &mut snapshots, observer);
                }
                let (steps, seconds) = (training.steps(), clock());
                return TrainedNetworks { snapshots, steps, seconds, stopped: false, diverged: Some(setback) };
            }
            (training.setbacks, kept.setbacks) = (times, times);
            continue;
        }
        let seconds = clock();
        let share = budget.share(training.steps(), seconds);
        let flow = report(&training, &learnt, share, seconds, observer);
        let due = share >= 1.0 || share * budget.snapshots as f64 >= (before + snapshots.len() + 1) as f64;
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
        end = (share >= 1.0 || flow == Flow::Stop).then_some(if share >= 1.0 { Flow::Continue } else { flow });
    }
    let (steps, stopped) = (training.steps(), end == Some(Flow::Stop));
    TrainedNetworks { snapshots, steps, seconds: clock(), stopped, diverged: None }
}

/// Takes a policy.
fn take<E: Environment>(
    training: &Training<E>,
    seconds: f64,
    snapshots: &mut Vec<NetworkSnapshot>,
    observer: &mut dyn Observer<E>,
) {
    let taken = NetworkSnapshot { network: training.network.clone(), steps: training.steps(), seconds };
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
    let mut tally = E::Tally::default();
    training.tiles.iter().for_each(|tile| tally.merge(&tile.tally));
    observer.iteration(&Iteration {
        index: training.iterations,
        steps: training.steps(),
        seconds,
        share,
        batch: training.batch(),
        learning_rate: learnt.learning_rate,
        losses: learnt.losses,
        explained_variance: learnt.explained_variance,
        advantage_std: learnt.advantage_std,
        std: training.network.log_std().iter().map(|s| s.exp() as f64).sum::<f64>() / 4.0,
        tally: &tally,
    })
}

/// Variance, summed in order in double precision.
fn variance(x: &[f32]) -> f64 {
    let n = x.len() as f64;
    let mean = x.iter().map(|&v| v as f64).sum::<f64>() / n;
    x.iter().map(|&v| (v as f64 - mean).powi(2)).sum::<f64>() / n
}
