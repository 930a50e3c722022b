//! One optimiser step on a minibatch: forward, loss and backward on tiles that stay in cache, a fixed-order sum, Adam.
//!
//! Work is cut into chunks of a fixed number of rows whatever the thread count, each with a gradient of its own, summed in
//! order: one thread and many give the same bits.

use super::loss::{Samples, TERMS, Weights, loss};
use crate::lane::{Kernel, LANES, Lane, Lane32, Level, Real, dispatch};
use crate::nn::adam::Adam;
use crate::nn::mlp::{self, Backward};
use crate::nn::{Network, Scratch, TILE_BLOCKS, TILE_SAMPLES};
use crate::policy::{self, ACTIONS};
use rayon::prelude::*;

/// A batch in rows of 16 samples; features lie `[row][feature][16]`.
#[derive(Clone, Copy)]
pub struct Batch<'a, E> {
    /// `[rows][observations][16]`
    pub observations: &'a [E],
    /// `[rows][4][16]`
    pub z: &'a [E],
    /// `[rows][16]` each.
    pub log_prob: &'a [E],
    pub advantages: &'a [E],
    pub returns: &'a [E],
}

/// What a step depends on besides the data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyper {
    pub weights: Weights,
    pub learning_rate: f64,
    pub max_gradient_norm: f64,
    pub adam_epsilon: f64,
}

/// Means over a minibatch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Losses {
    pub total: f64,
    pub surrogate: f64,
    pub value: f64,
    pub entropy: f64,
    pub magnitude: f64,
    /// Mean of (ratio - 1) - log ratio; healthy below about 0.02.
    pub approx_kl: f64,
    /// Share of ratios outside 1 +- clip; healthy at 0.05 to 0.3.
    pub clip_fraction: f64,
    /// Norm of the gradient before clipping.
    pub gradient_norm: f64,
}

/// Rows of a chunk: the unit of work, 512 samples.
const CHUNK_ROWS: usize = 32;

/// A chunk's own sums.
struct Chunk<E> {
    gradient: Vec<E>,
    terms: [f64; TERMS.len()],
    tile: TileScratch<E>,
}

struct TileScratch<E> {
    x: Vec<E>,
    hidden: Scratch<E>,
    backward: Backward<E>,
    mean: Vec<E>,
    value: Vec<E>,
}

/// The optimiser and its memory.
pub struct Updater<E> {
    pub adam: Adam<E>,
    pub gradient: Vec<E>,
    chunks: Vec<Chunk<E>>,
}

impl Updater<f32> {
    /// Changes `network` by one step on the samples of `rows`; the number of rows is a multiple of 4.
    pub fn step(
        &mut self,
        level: Level,
        network: &mut Network<f32>,
        batch: &Batch<f32>,
        rows: &[u32],
        hyper: &Hyper,
    ) -> Losses {
        self.prepare(network, rows);
        let (shared, samples) = (&*network, rows.len() * LANES);
        self.chunks.par_iter_mut().zip(rows.par_chunks(CHUNK_ROWS)).for_each(|(chunk, rows)| {
            dispatch(level, Work { network: shared, batch, rows, samples, weights: &hyper.weights, chunk });
        });
        self.finish(network, rows, hyper)
    }
}

impl<E: Real<Mask = bool> + PartialOrd + Default + Into<f64>> Updater<E> {
    pub fn new(network: &Network<E>) -> Self {
        let n = network.parameters.len();
        Updater { adam: Adam::new(n), gradient: vec![E::default(); n], chunks: Vec::new() }
    }

    /// The same step on one thread with blocks `L`: gradients in double precision for tests.
    pub fn step_with<L: Lane<Elem = E>>(
        &mut self,
        network: &mut Network<E>,
        batch: &Batch<E>,
        rows: &[u32],
        hyper: &Hyper,
    ) -> Losses {
        self.prepare(network, rows);
        for (chunk, part) in self.chunks.iter_mut().zip(rows.chunks(CHUNK_ROWS)) {
            chunk.run::<L>(network, batch, part, rows.len() * LANES, &hyper.weights);
        }
        self.finish(network, rows, hyper)
    }

    fn prepare(&mut self, network: &Network<E>, rows: &[u32]) {
        assert!(rows.len() % TILE_BLOCKS == 0, "rows come in tiles of {TILE_BLOCKS}");
        self.chunks.resize_with(rows.len().div_ceil(CHUNK_ROWS), || Chunk::new(network));
    }

    /// Sums the chunks in order, clips, steps.
    fn finish(&mut self, network: &mut Network<E>, rows: &[u32], hyper: &Hyper) -> Losses {
        const SLICE: usize = 1024;
        let chunks = &self.chunks;
        self.gradient.par_chunks_mut(SLICE).enumerate().for_each(|(i, out)| {
            out.fill(E::default());
            for chunk in chunks {
                let from = &chunk.gradient[i * SLICE..][..out.len()];
                out.iter_mut().zip(from).for_each(|(sum, &g)| *sum = *sum + g);
            }
        });
        let w = &hyper.weights;
        for g in &mut self.gradient[network.log_std_range()] {
            *g = *g - E::of(w.entropy);
        }
        let norm = self.gradient.iter().map(|&g| g.into() * g.into()).sum::<f64>().sqrt();
        let scale = (hyper.max_gradient_norm / norm.max(f64::MIN_POSITIVE)).min(1.0);
        let entropy = policy::entropy(network.log_std().map(Into::into));
        self.adam.step(&mut network.parameters, &self.gradient, E::of(scale), hyper.learning_rate, hyper.adam_epsilon);

        let mut sums = [0.0; TERMS.len()];
        chunks.iter().for_each(|c| sums.iter_mut().zip(c.terms).for_each(|(s, t)| *s += t));
        let [surrogate, value, magnitude, approx_kl, clip_fraction] = sums.map(|s| s / (rows.len() * LANES) as f64);
        let total = surrogate - w.entropy * entropy + w.magnitude * magnitude + w.value * value;
        Losses { total, surrogate, value, entropy, magnitude, approx_kl, clip_fraction, gradient_norm: norm }
    }
}

struct Work<'a> {
    network: &'a Network<f32>,
    batch: &'a Batch<'a, f32>,
    rows: &'a [u32],
    samples: usize,
    weights: &'a Weights,
    chunk: &'a mut Chunk<f32>,
}

impl Kernel for Work<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        self.chunk.run::<L>(self.network, self.batch, self.rows, self.samples, self.weights);
    }
}

impl<E: Real<Mask = bool> + PartialOrd + Default + Into<f64>> Chunk<E> {
    fn new(network: &Network<E>) -> Self {
        let tile = |features: usize| vec![E::default(); features * TILE_SAMPLES];
        Chunk {
            gradient: vec![E::default(); network.parameters.len()],
            terms: [0.0; TERMS.len()],
            tile: TileScratch {
                x: tile(network.inputs()),
                hidden: Scratch { actor: Default::default(), critic: Default::default() },
                backward: Default::default(),
                mean: tile(ACTIONS),
                value: tile(1),
            },
        }
    }

    /// Gradient and loss of `rows`.
    #[inline(always)]
    fn run<L: Lane<Elem = E>>(
        &mut self,
        network: &Network<E>,
        batch: &Batch<E>,
        rows: &[u32],
        samples: usize,
        weights: &Weights,
    ) {
        self.gradient.fill(E::default());
        let share = L::of(1.0 / samples as f64);
        let log_std = network.log_std().map(L::splat);
        let (mut terms, mut d_log_std) = ([L::zero(); TERMS.len()], [L::zero(); ACTIONS]);
        let TileScratch { x, hidden, backward, mean, value } = &mut self.tile;
        for rows in rows.chunks_exact(TILE_BLOCKS) {
            let n = network.inputs();
            for (b, &row) in rows.iter().enumerate() {
                let from = &batch.observations[row as usize * n * LANES..][..n * LANES];
                for (k, from) in from.chunks_exact(LANES).enumerate() {
                    x[k * TILE_SAMPLES + b * LANES..][..LANES].copy_from_slice(from);
                }
            }
            network.forward::<L>(x, hidden, mean, value);
            for (b, &row) in rows.iter().enumerate() {
                let row = row as usize;
                let column = |k: usize| k * TILE_SAMPLES + b * LANES;
                let z = &batch.z[row * ACTIONS * LANES..];
                let answer = loss(
                    weights,
                    &Samples {
                        mean: std::array::from_fn(|k| L::from_slice(&mean[column(k)..])),
                        log_std,
                        value: L::from_slice(&value[column(0)..]),
                        z: std::array::from_fn(|k| L::from_slice(&z[k * LANES..])),
                        old_log_prob: L::from_slice(&batch.log_prob[row * LANES..]),
                        advantage: L::from_slice(&batch.advantages[row * LANES..]),
                        ret: L::from_slice(&batch.returns[row * LANES..]),
                    },
                    share,
                );
                for k in 0..ACTIONS {
                    answer.d_mean[k].write(&mut mean[column(k)..]);
                    d_log_std[k] = d_log_std[k] + answer.d_log_std[k];
                }
                answer.d_value.write(&mut value[column(0)..]);
                terms.iter_mut().zip(answer.terms).for_each(|(sum, term)| *sum = *sum + term);
            }
            let (p, g) = (&network.parameters, &mut self.gradient);
            mlp::backward::<L>(&network.actor, p, x, &hidden.actor, mean, backward, g);
            mlp::backward::<L>(&network.critic, p, x, &hidden.critic, value, backward, g);
        }
        self.terms = terms.map(|t| t.sum().into());
        let at = network.log_std_range().start;
        (0..ACTIONS).for_each(|k| self.gradient[at + k] = d_log_std[k].sum());
    }
}
