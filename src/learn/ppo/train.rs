//! The training loop: rollout, advantages, update, snapshot.

use super::awake::awake;
use super::batch::Batch;
use super::config::{BudgetConfig, PpoConfig};
use super::loss::Weights;
use super::rollout::{Rollout, Tile, collect};
use super::update::{Hyper, Losses, Updater};
use super::{Environment, Tally, gae};
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
pub trait Observer<T> {
    fn iteration(&mut self, iteration: &Iteration<T>) -> Flow;
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
        }
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

    /// Generalised advantages of the rollout, normalised over the batch; returns the explained variance.
    fn advantages(&mut self) -> f64 {
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
        1.0 - residual / total.max(1e-12)
    }

    /// Rollout, advantages and all epochs of one iteration at `share` of the budget.
    pub fn iterate(&mut self, share: f64) -> (Losses, f64, f64) {
        let c = self.config;
        let penalty = c.penalty(share);
        self.collect(&self.environment.with_penalties(penalty));
        let explained = self.advantages();
        let learning_rate = c.learning_rate + (c.learning_rate_final - c.learning_rate) * share.clamp(0.0, 1.0);
        let hyper = Hyper {
            weights: Weights {
                clip: c.clip,
                entropy: c.entropy,
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
        (losses, explained, learning_rate)
    }
}

/// Trains under `budget` on the current rayon pool. The clock starts with the first iteration and includes rollouts,
/// updates and snapshots (paper section 5.1).
pub fn train<E: Environment>(
    level: Level,
    environment: &E,
    config: &PpoConfig,
    budget: &BudgetConfig,
    seed: u64,
    observer: &mut dyn Observer<E::Tally>,
) -> TrainedNetworks {
    let mut training = Training::new(level, environment, config, seed);
    let started = Instant::now();
    let (mut snapshots, mut steps) = (Vec::new(), 0u64);
    loop {
        let share = budget.share(steps, started.elapsed().as_secs_f64());
        let (losses, explained_variance, learning_rate) = training.iterate(share);
        steps += training.batch() as u64;
        let mut tally = E::Tally::default();
        training.tiles.iter().for_each(|tile| tally.merge(&tile.tally));
        let seconds = started.elapsed().as_secs_f64();
        let share = budget.share(steps, seconds);
        let flow = observer.iteration(&Iteration {
            index: training.iterations,
            steps,
            seconds,
            share,
            batch: training.batch(),
            learning_rate,
            losses,
            explained_variance,
            std: training.network.log_std().iter().map(|s| s.exp() as f64).sum::<f64>() / 4.0,
            tally: &tally,
        });
        let done = share >= 1.0 || flow == Flow::Stop;
        if done || share * budget.snapshots as f64 >= (snapshots.len() + 1) as f64 {
            snapshots.push(NetworkSnapshot { network: training.network.clone(), steps, seconds });
        }
        if done {
            return TrainedNetworks { snapshots, steps, seconds, stopped: share < 1.0 };
        }
    }
}

/// Variance, summed in order in double precision.
fn variance(x: &[f32]) -> f64 {
    let n = x.len() as f64;
    let mean = x.iter().map(|&v| v as f64).sum::<f64>() / n;
    x.iter().map(|&v| (v as f64 - mean).powi(2)).sum::<f64>() / n
}
