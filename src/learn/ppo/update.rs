//! One optimiser step on a minibatch: forward, loss and backward on tiles that stay in cache, a fixed-order sum, Adam.
//!
//! Work is cut into chunks of a fixed number of rows whatever the thread count, each with a gradient of its own, summed
//! in order: one thread and many give the same bits.

pub mod parts;

use super::batch::Minibatch;
use super::chunk::{Chunk, Job, Worker};
use super::config::ProductPrecision;
use super::loss::{TERMS, Weights};
use crate::base::lane::{Kernel, LANES, Lane, Lane32, Level, Real, dispatch};
use crate::learn::nn::adam::Adam;
use crate::learn::nn::aligned::Aligned;
use crate::learn::nn::bf16::Bf16;
use crate::learn::nn::gemm::{Exact, Precision};
use crate::learn::nn::{HIDDEN, Network, mlp};
use crate::learn::policy;
use rayon::prelude::*;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What a step depends on besides the data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyper {
    pub precision: ProductPrecision,
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
    /// Mean of the squared parts of the mean beyond full stick; 0 where nothing saturates.
    pub saturation: f64,
    /// Mean of (ratio - 1) - log ratio; healthy below about 0.02.
    pub approx_kl: f64,
    /// Share of ratios outside 1 +- clip; healthy at 0.05 to 0.3.
    pub clip_fraction: f64,
    /// Norm of the gradient before clipping.
    pub gradient_norm: f64,
}

/// Rows of a chunk, the unit of work: 128 samples, so that even a minibatch of 512 keeps four cores busy.
const CHUNK_ROWS: usize = 8;
const POISONED: &str = "no thread panicked over a chunk";

/// The optimiser and its memory.
pub struct Updater<E> {
    pub adam: Adam<E>,
    /// The last step's gradient, before clipping.
    pub gradient: Aligned<E>,
    /// Transposes of the second layers' weights: actor, critic.
    turned: [Aligned<E>; 2],
    chunks: Vec<Mutex<Chunk<E>>>,
    /// One for each thread.
    workers: Vec<Worker<E>>,
}

impl Updater<f32> {
    /// Changes `network` by one step on the samples of `rows`, on the current rayon pool.
    pub fn step(
        &mut self,
        level: Level,
        network: &mut Network<f32>,
        batch: &Minibatch<f32>,
        rows: &[u32],
        hyper: &Hyper,
    ) -> Losses {
        dispatch(level, UpdateStep { updater: self, network, batch, rows, hyper })
    }
}

struct UpdateStep<'a> {
    updater: &'a mut Updater<f32>,
    network: &'a mut Network<f32>,
    batch: &'a Minibatch<'a, f32>,
    rows: &'a [u32],
    hyper: &'a Hyper,
}

impl Kernel for UpdateStep<'_> {
    type Output = Losses;
    #[inline(always)]
    fn run<L: Lane32>(self) -> Losses {
        let Self { updater, network, batch, rows, hyper } = self;
        match hyper.precision {
            ProductPrecision::F32 => updater.step_with::<L, Exact>(network, batch, rows, hyper),
            ProductPrecision::Bf16 => updater.step_with::<L, Bf16>(network, batch, rows, hyper),
        }
    }
}

impl<E: Real<Mask = bool> + PartialOrd + Default + Into<f64>> Updater<E> {
    pub fn new(network: &Network<E>) -> Self {
        let n = network.parameters.len();
        Updater {
            adam: Adam::new(n),
            gradient: Aligned::zeros(n),
            turned: [Aligned::zeros(HIDDEN * HIDDEN), Aligned::zeros(HIDDEN * HIDDEN)],
            chunks: Vec::new(),
            workers: Vec::new(),
        }
    }

    /// The same step with blocks `L`: in double precision for tests.
    pub fn step_with<L: Lane<Elem = E>, P: Precision<L>>(
        &mut self,
        network: &mut Network<E>,
        batch: &Minibatch<E>,
        rows: &[u32],
        hyper: &Hyper,
    ) -> Losses {
        let losses = self.differentiate::<L, P>(network, batch, rows, &hyper.weights);
        self.descend::<L>(network, hyper, losses.gradient_norm);
        losses
    }

    /// Loss and gradient alone.
    pub fn differentiate<L: Lane<Elem = E>, P: Precision<L>>(
        &mut self,
        network: &Network<E>,
        batch: &Minibatch<E>,
        rows: &[u32],
        weights: &Weights,
    ) -> Losses {
        assert!(!rows.is_empty(), "a minibatch of nothing");
        for (shape, turned) in [&network.actor, &network.critic].into_iter().zip(&mut self.turned) {
            L::vectorize(
                #[inline(always)]
                || mlp::turn::<L>(shape, &network.parameters, turned),
            );
        }
        let parts = rows.len().div_ceil(CHUNK_ROWS);
        self.chunks.resize_with(parts, || Mutex::new(Chunk::new(network)));
        self.workers.resize_with(rayon::current_num_threads(), || Worker::new(network));
        let share = 1.0 / (rows.len() * LANES) as f64;
        let job = Job { network, turned: &self.turned, batch, weights, share };
        let (chunks, next) = (&self.chunks, AtomicUsize::new(0));
        // A free thread takes the next chunk: which thread it is makes no difference to the chunk's result.
        self.workers.par_iter_mut().with_max_len(1).for_each(|worker| {
            loop {
                let part = next.fetch_add(1, Ordering::Relaxed);
                let Some(chunk) = chunks.get(part) else { break };
                let rows = &rows[part * CHUNK_ROWS..rows.len().min((part + 1) * CHUNK_ROWS)];
                chunk.lock().expect(POISONED).run::<L, P>(&job, rows, worker);
            }
        });
        let norm = self.reduce::<L>(network, weights.entropy);

        let mut sums = [0.0; TERMS.len()];
        for chunk in &mut self.chunks {
            let terms = chunk.get_mut().expect(POISONED).terms;
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term * share);
        }
        let [surrogate, value, magnitude, saturation, approx_kl, clip_fraction, squash] = sums;
        let entropy = policy::entropy(network.log_std().map(Into::into)) + squash;
        let costs = weights.magnitude * magnitude + weights.saturation * saturation + weights.value * value;
        let total = surrogate - weights.entropy * entropy + costs;
        Losses {
            total,
            surrogate,
            value,
            entropy,
            magnitude,
            saturation,
            approx_kl,
            clip_fraction,
            gradient_norm: norm,
        }
    }

    /// Sums the chunks' gradients in their order, adds the entropy's, and returns the norm. On one thread, as the step
    /// that follows: both together take less time than waking the others.
    fn reduce<L: Lane<Elem = E>>(&mut self, network: &Network<E>, entropy: f64) -> f64 {
        let sum = &mut self.gradient;
        for (part, chunk) in self.chunks.iter_mut().enumerate() {
            let from = &chunk.get_mut().expect(POISONED).gradient;
            L::vectorize(
                #[inline(always)]
                || {
                    for (sum, from) in sum.chunks_exact_mut(LANES).zip(from.chunks_exact(LANES)) {
                        let before = if part == 0 { L::zero() } else { L::from_slice(sum) };
                        (before + L::from_slice(from)).write(sum);
                    }
                },
            );
        }
        for g in &mut sum[network.log_std_range()] {
            *g = *g - E::of(entropy);
        }
        let squares = L::vectorize(
            #[inline(always)]
            || {
                let mut squares = L::zero();
                for g in sum.chunks_exact(LANES) {
                    squares = L::from_slice(g).mul_add(L::from_slice(g), squares);
                }
                squares.sum()
            },
        );
        squares.into().sqrt()
    }

    /// Clips the gradient and steps against it.
    fn descend<L: Lane<Elem = E>>(&mut self, network: &mut Network<E>, hyper: &Hyper, norm: f64) {
        let rates = self.adam.advance(hyper.learning_rate, hyper.adam_epsilon);
        let scale = E::of((hyper.max_gradient_norm / norm.max(f64::MIN_POSITIVE)).min(1.0));
        let Adam { first, second, .. } = &mut self.adam;
        L::vectorize(
            #[inline(always)]
            || rates.step::<L>(&mut network.parameters, first, second, &self.gradient, scale),
        );
    }
}
