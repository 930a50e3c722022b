//! Where an iteration of training spends its time, and what that says of machines with more processors.
//!
//! An iteration is a rollout, whose tiles threads share; advantages and shuffling; and optimiser steps, whose chunks
//! and spans threads share and whose transposes each does for itself. The model counts these and nothing else: clocks
//! that fall when more processors work, caches and memory that they share are left out.

use crate::base::lane::Level;
use crate::base::stopwatch::best;
use crate::learn::nn::TILE_SAMPLES;
use crate::learn::ppo::training::Training;
use crate::learn::ppo::update::parts::StepParts;
use crate::race::config::Config;
use crate::race::env::Race;
use std::time::Duration;

/// Numbers of threads that are predicted.
pub const THREADS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];

/// An iteration's parts, s, on one thread.
#[derive(Clone, Copy, Debug)]
pub struct ThreadsModel {
    pub step: StepParts,
    /// Optimiser steps of an iteration.
    pub steps: usize,
    pub rollout: f64,
    /// Tiles of environments that threads can share.
    pub tiles: usize,
    /// Advantages, shuffling, and what else no part counts.
    pub rest: f64,
    /// What a step on all threads takes longer than its parts: handing out chunks and waiting for the last, s, for each
    /// doubling of the threads.
    pub wake: f64,
    /// Environment steps of an iteration.
    pub batch: usize,
    /// Threads, and environment steps a second that they were seen to train.
    pub seen: [(usize, f64); 2],
}

impl ThreadsModel {
    /// Measures on one thread and on `threads`, for about `time`.
    pub fn measure(config: &Config, race: &Race, level: Level, threads: usize, time: Duration) -> Self {
        let part = time / 6;
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
            pool.install(|| {
                let mut training = Training::new(level, race, &config.ppo, config.seed);
                let rollout = best(part, || training.collect(race));
                let iteration = best(part, || training.iterate(0.0));
                (rollout, iteration, training.batch(), training.parts(part))
            })
        };
        let ((rollout, one, batch, step), (_, all, _, shared)) = (on(1), on(threads));
        let steps = config.ppo.epochs * config.ppo.minibatches;
        let rest = (one - rollout - steps as f64 * step.whole).max(0.0);
        let tiles = config.ppo.environments / TILE_SAMPLES;
        let seen = [(1, batch as f64 / one), (threads, batch as f64 / all)];
        let mut model = Self { step, steps, rollout, tiles, rest, wake: 0.0, batch, seen };
        if threads > 1 {
            model.wake = ((shared.whole - model.step_s(threads)) / (threads as f64).log2()).max(0.0);
        }
        model
    }

    /// An optimiser step on so many threads, s.
    pub fn step_s(&self, threads: usize) -> f64 {
        let StepParts { transpose, chunks, .. } = self.step;
        let chunked = self.step.chunked() / chunks as f64 * chunks.div_ceil(threads) as f64;
        transpose + self.step.spanned() / threads as f64 + chunked + self.wake * (threads as f64).log2()
    }

    /// Environment steps a second that so many threads are predicted to train.
    pub fn predicted(&self, threads: usize) -> f64 {
        let rollout = self.rollout / self.tiles as f64 * self.tiles.div_ceil(threads) as f64;
        self.batch as f64 / (rollout + self.rest + self.steps as f64 * self.step_s(threads))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shared_is_divided_and_the_rest_is_not() {
        let step = StepParts { whole: 10.0, transpose: 0.5, sum: 1.0, adam: 0.5, chunks: 4, ..StepParts::default() };
        let seen = [(1, 1.0), (2, 1.0)];
        let model = ThreadsModel { step, steps: 3, rollout: 8.0, tiles: 8, rest: 2.0, wake: 0.25, batch: 100, seen };
        assert_eq!([1, 2, 3, 4, 16].map(|n| model.step_s(n)), [10.0, 5.5, 5.0 + 0.25 * 3f64.log2(), 3.375, 3.59375]);
        assert_eq!(model.predicted(1), 100.0 / (8.0 + 2.0 + 30.0));
        assert_eq!(model.predicted(4), 100.0 / (2.0 + 2.0 + 3.0 * 3.375));
    }
}
