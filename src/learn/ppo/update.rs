//! One optimiser step on a minibatch: forward, loss and backward on tiles that stay in cache, a fixed-order sum, Adam.
//!
//! Work is cut into chunks of a fixed number of rows whatever the thread count, each with a gradient of its own, summed
//! in order: one thread and many give the same bits. Sum and Adam are cut into as many spans of the parameters as there
//! are threads. What one thread does for all others, all of them fetch from its processor's cache: where that is far
//! away, on another die, it takes longer than doing it.

pub mod parts;
mod span;

use super::batch::Minibatch;
use super::chunk::{Chunk, Job, Worker};
use super::config::ProductPrecision;
use super::loss::{TERMS, Weights};
use super::shared_parts::SharedParts;
use crate::base::lane::{Kernel, LANES, Lane, Lane32, Level, Real, dispatch};
use crate::base::wait::wait;
use crate::learn::nn::Network;
use crate::learn::nn::adam::Adam;
use crate::learn::nn::aligned::Aligned;
use crate::learn::nn::bf16::Bf16;
use crate::learn::nn::gemm::{Exact, Precision};
use crate::learn::policy;
use rayon::prelude::*;
use span::spans;
use std::mem::swap;
use std::sync::{OnceLock, PoisonError, RwLock};

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
    /// The parameters after the step.
    next: Aligned<E>,
    chunks: Vec<RwLock<Chunk<E>>>,
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
            next: Aligned::zeros(n),
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
        let losses = self.differentiate::<L, P>(network, batch, rows, &hyper.weights, Some(hyper));
        swap(&mut network.parameters, &mut self.next);
        losses
    }

    /// Loss and gradient, and with `hyper` the parameters that a step leads to.
    pub fn differentiate<L: Lane<Elem = E>, P: Precision<L>>(
        &mut self,
        network: &Network<E>,
        batch: &Minibatch<E>,
        rows: &[u32],
        weights: &Weights,
        hyper: Option<&Hyper>,
    ) -> Losses {
        assert!(!rows.is_empty(), "a minibatch of nothing");
        let Self { adam, gradient, next, chunks, workers } = self;
        chunks.resize_with(rows.len().div_ceil(CHUNK_ROWS), || RwLock::new(Chunk::new(network)));
        workers.resize_with(rayon::current_num_threads(), || Worker::new(network));
        let share = 1.0 / (rows.len() * LANES) as f64;
        let job = Job { network, batch, weights, share };
        let rates = hyper.map(|hyper| (hyper, adam.advance(hyper.learning_rate, hyper.adam_epsilon)));
        let spans = spans(workers.len(), gradient, adam, next);
        let squares: Vec<OnceLock<L>> = spans.iter().map(|_| OnceLock::new()).collect();
        let norm = || squares.last().and_then(OnceLock::get).expect("summed").sum().into().sqrt();
        let [chunked, summed, stepped] = [chunks.len(), spans.len(), spans.len()].map(SharedParts::new);
        // Which thread does a part makes no difference to its result.
        workers.par_iter_mut().with_max_len(1).for_each(|worker| {
            worker.turn::<L>(network);
            chunked.share(|part| {
                let rows = &rows[part * CHUNK_ROWS..rows.len().min((part + 1) * CHUNK_ROWS)];
                chunks[part].write().expect(POISONED).run::<L, P>(&job, rows, worker);
            });
            summed.share(|part| {
                let mut span = spans[part].lock().expect(POISONED);
                for (number, chunk) in chunks.iter().enumerate() {
                    // Where a chunk panicked, others wait for this sum.
                    span.add::<L>(number, &chunk.read().unwrap_or_else(PoisonError::into_inner).gradient);
                }
                span.entropy(weights.entropy, network.log_std_range());
                let before = part.checked_sub(1).map(|before| &squares[before]);
                wait(|| before.is_none_or(|before| before.get().is_some()));
                squares[part]
                    .get_or_init(|| span.squares(before.and_then(OnceLock::get).copied().unwrap_or(L::zero())));
            });
            if let Some((hyper, rates)) = &rates {
                // Clipped to the largest norm.
                let scale = E::of((hyper.max_gradient_norm / norm().max(f64::MIN_POSITIVE)).min(1.0));
                let step = |part: usize| {
                    spans[part].lock().expect(POISONED).descend::<L>(rates, &network.parameters, scale);
                };
                stepped.share(step);
            }
        });
        let gradient_norm = norm();
        losses(chunks, network, weights, share, gradient_norm)
    }
}

/// The chunks' losses together, of samples that have this `share` each.
fn losses<E: Real<Mask = bool> + PartialOrd + Default + Into<f64>>(
    chunks: &mut [RwLock<Chunk<E>>],
    network: &Network<E>,
    weights: &Weights,
    share: f64,
    gradient_norm: f64,
) -> Losses {
    let mut sums = [0.0; TERMS.len()];
    for chunk in chunks {
        let terms = chunk.get_mut().expect(POISONED).terms;
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term * share);
    }
    let [surrogate, value, magnitude, saturation, approx_kl, clip_fraction, squash] = sums;
    let entropy = policy::entropy(network.log_std().map(Into::into)) + squash;
    let costs = weights.magnitude * magnitude + weights.saturation * saturation + weights.value * value;
    let total = surrogate - weights.entropy * entropy + costs;
    Losses { total, surrogate, value, entropy, magnitude, saturation, approx_kl, clip_fraction, gradient_norm }
}
