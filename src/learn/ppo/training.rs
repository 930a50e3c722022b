//! A training under way: what one iteration reads and changes.

use super::awake::awake;
use super::batch::Minibatch;
use super::config::PpoConfig;
use super::loss::Weights;
use super::rollout::{Explorer, Rollout, Tile, collect};
use super::state::{TrainingState, rate_after};
use super::update::parts::{self, StepParts};
use super::update::{Hyper, Losses, Updater};
use super::{Environment, Tally as _, gae};
use crate::base::lane::Level;
use crate::base::rng::{Philox, RngStream};
use crate::learn::nn::adam::Adam;
use crate::learn::nn::{Network, TILE_BLOCKS, TILE_SAMPLES};
use rand::seq::SliceRandom;
use rayon::prelude::*;
use std::time::Duration;

/// What an iteration computed.
pub struct Learnt {
    pub losses: Losses,
    pub explained_variance: f64,
    /// Of the advantages, before they are normalised.
    pub advantage_std: f64,
    pub learning_rate: f64,
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
    average: Network<f32>,
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
            &mut rng.sequence(RngStream::Weights, 0, 0),
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
            average: network.clone(),
            network,
            iterations: 0,
            setbacks: 0,
        }
    }

    /// Iterations done.
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// The networks as they are.
    pub fn network(&self) -> &Network<f32> {
        &self.network
    }

    /// What is taken of them: their weights, averaged over the last [`PpoConfig::average`] of the iterations.
    pub fn average(&self) -> &Network<f32> {
        &self.average
    }

    /// The optimiser's moments.
    pub fn adam(&self) -> &Adam<f32> {
        &self.updater.adam
    }

    /// What happened in the last rollout.
    pub fn tally(&self) -> E::Tally {
        let mut tally = E::Tally::default();
        self.tiles.iter().for_each(|tile| tally.merge(&tile.tally));
        tally
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
            average: self.average.clone(),
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
        self.average = state.average.clone();
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
        let explorer = Explorer { network: &self.network, precision: self.config.precision, rng: &self.rng };
        collect(self.level, environment, explorer, &mut self.tiles, &mut self.rollout, first_step);
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

    /// What the parts of an optimiser step cost, on a rollout of its own. The training is of no use afterwards.
    pub fn parts(&mut self, time: Duration) -> StepParts {
        self.collect(self.environment);
        self.advantages();
        let hyper = self.hyper(0.0);
        let Self { level, rollout, advantages, returns, order, updater, network, config, .. } = self;
        let batch = batch(rollout, advantages, returns);
        let rows = &order[..order.len() / config.minibatches];
        awake(|| parts::measure(updater, *level, network, &batch, rows, &hyper, time))
    }

    /// What the steps of an iteration depend on, at `share` of the budget.
    fn hyper(&self, share: f64) -> Hyper {
        let c = self.config;
        Hyper {
            precision: self.config.precision,
            weights: Weights {
                clip: c.clip,
                entropy: c.entropy_at(share),
                squashed: c.entropy_squashed,
                magnitude: c.action_magnitude * c.penalty(share),
                saturation: c.saturation_at(self.steps()),
                value: c.value_coefficient,
            },
            learning_rate: c.learning_rate_at(self.steps(), share) * rate_after(self.setbacks),
            max_gradient_norm: c.max_gradient_norm,
            adam_epsilon: c.adam_epsilon,
        }
    }

    /// Rollout, advantages and all epochs of one iteration at `share` of the budget.
    pub fn iterate(&mut self, share: f64) -> Learnt {
        let c = self.config;
        self.collect(&self.environment.at(self.steps(), share, c.penalty(share)));
        let (explained_variance, advantage_std) = self.advantages();
        let hyper = self.hyper(share);
        let learning_rate = hyper.learning_rate;
        let batch = batch(&self.rollout, &self.advantages, &self.returns);
        let (level, order, updater, network) = (self.level, &mut self.order, &mut self.updater, &mut self.network);
        let shuffles =
            (0..c.epochs).map(|epoch| self.rng.sequence(RngStream::Shuffle, epoch as u32, self.iterations as u32));
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
        self.average.toward(&self.network, c.renewed(self.iterations));
        Learnt { losses, explained_variance, advantage_std, learning_rate }
    }
}

fn batch<'a>(rollout: &'a Rollout, advantages: &'a [f32], returns: &'a [f32]) -> Minibatch<'a, f32> {
    let Rollout { observations, z, log_prob, .. } = rollout;
    Minibatch { observations, z, log_prob, advantages, returns }
}

/// Variance, summed in order in double precision.
fn variance(x: &[f32]) -> f64 {
    let n = x.len() as f64;
    let mean = x.iter().map(|&v| v as f64).sum::<f64>() / n;
    x.iter().map(|&v| (v as f64 - mean).powi(2)).sum::<f64>() / n
}
