//! Loss and gradient of a chunk of a minibatch, in tiles whose activations stay in cache from the first layer's forward
//! to the first layer's gradient.

pub mod parts;

use super::batch::Minibatch;
use super::loss::{Samples, TERMS, Weights, loss};
use crate::base::lane::{LANES, Lane, Real, build};
use crate::learn::nn::aligned::Aligned;
use crate::learn::nn::gemm::Precision;
use crate::learn::nn::mlp::{self, Hidden, Layout};
use crate::learn::nn::{HIDDEN, Network};
use crate::learn::policy::ACTIONS;

/// Rows of 16 samples in a tile.
pub const TILE_ROWS: usize = 4;
const PITCH: usize = TILE_ROWS * LANES;

/// What all chunks of a minibatch share.
pub struct Job<'a, E> {
    pub network: &'a Network<E>,
    pub batch: &'a Minibatch<'a, E>,
    pub weights: &'a Weights,
    /// 1 over the samples of the minibatch.
    pub share: f64,
}

/// A chunk's sums over its samples.
pub struct Chunk<E> {
    /// In the order of [`Network::parameters`].
    pub gradient: Aligned<E>,
    /// The loss's [`TERMS`].
    pub terms: [f64; TERMS.len()],
}

/// A thread's memory for one tile, `[feature][sample]` but for the hidden layers.
pub struct Worker<E> {
    x: Aligned<E>,
    actor: Hidden<E>,
    critic: Hidden<E>,
    mean: Aligned<E>,
    value: Aligned<E>,
    /// The second layers' weights, transposed: actor, critic.
    turned: [Aligned<E>; 2],
}

impl<E: Copy + Default> Worker<E> {
    pub fn new(network: &Network<E>) -> Self {
        let tile = |features| Aligned::zeros(features * PITCH);
        Worker {
            x: tile(network.inputs()),
            actor: Hidden::new(PITCH),
            critic: Hidden::new(PITCH),
            mean: tile(ACTIONS),
            value: tile(1),
            turned: [Aligned::zeros(HIDDEN * HIDDEN), Aligned::zeros(HIDDEN * HIDDEN)],
        }
    }

    /// Transposes what the chunks of a step need so.
    pub fn turn<L: Lane<Elem = E>>(&mut self, network: &Network<E>) {
        for (shape, turned) in [&network.actor, &network.critic].into_iter().zip(&mut self.turned) {
            L::vectorize(
                #[inline(always)]
                || mlp::turn::<L>(shape, &network.parameters, turned),
            );
        }
    }
}

/// Sums over a chunk that stay in registers' form until its end.
struct Sums<L> {
    terms: [L; TERMS.len()],
    mean: [L; ACTIONS],
    log_std: [L; ACTIONS],
    value: L,
}

impl<E: Real<Mask = bool> + PartialOrd + Default + Into<f64>> Chunk<E> {
    pub fn new(network: &Network<E>) -> Self {
        Chunk { gradient: Aligned::zeros(network.parameters.len()), terms: [0.0; TERMS.len()] }
    }

    /// Gradient and loss of `rows`.
    pub fn run<L: Lane<Elem = E>, P: Precision<L>>(&mut self, job: &Job<E>, rows: &[u32], worker: &mut Worker<E>) {
        self.gradient.fill(E::default());
        let zero = L::zero();
        let mut sums =
            Sums { terms: [zero; TERMS.len()], mean: [zero; ACTIONS], log_std: [zero; ACTIONS], value: zero };
        for rows in rows.chunks(TILE_ROWS) {
            L::vectorize(
                #[inline(always)]
                || tile::<L, P>(job, rows, worker, &mut sums, &mut self.gradient),
            );
        }
        self.terms = sums.terms.map(|t| t.sum().into());
        let Network { actor, critic, .. } = job.network;
        let mut set = |at: usize, sum: L| self.gradient[at] = sum.sum();
        for k in 0..ACTIONS {
            set(job.network.log_std_range().start + k, sums.log_std[k]);
            set(actor.head_biases().start + k, sums.mean[k]);
        }
        set(critic.head_biases().start, sums.value);
    }
}

/// Adds a tile's gradient to `gradient` and `sums`.
#[inline(always)]
fn tile<L: Lane, P: Precision<L>>(
    job: &Job<L::Elem>,
    rows: &[u32],
    worker: &mut Worker<L::Elem>,
    sums: &mut Sums<L>,
    gradient: &mut [L::Elem],
) {
    let Worker { x, actor, critic, mean, value, turned } = worker;
    let (network, samples) = (job.network, rows.len() * LANES);
    let p = &network.parameters;
    gather::<L>(job.batch.observations, network.inputs(), rows, x);
    mlp::forward::<L, P>(&network.actor, p, samples, PITCH, x, actor, mean);
    mlp::forward::<L, P>(&network.critic, p, samples, PITCH, x, critic, value);
    differentiate_loss::<L>(job, rows, mean, value, sums);
    let mut back = |shape: &Layout, turned: &[L::Elem], h: &mut Hidden<L::Elem>, dy: &[L::Elem]| {
        mlp::backward::<L, P>(shape, p, turned, samples, PITCH, x, h, dy, gradient);
    };
    back(&network.actor, &turned[0], actor, mean);
    back(&network.critic, &turned[1], critic, value);
}

/// Copies the observations `[row][feature][16]` of `rows` side by side: `x` `[feature][PITCH]`.
#[inline(always)]
fn gather<L: Lane>(observations: &[L::Elem], features: usize, rows: &[u32], x: &mut [L::Elem]) {
    for (b, &row) in rows.iter().enumerate() {
        let from = &observations[row as usize * features * LANES..][..features * LANES];
        for (from, to) in from.chunks_exact(LANES).zip(x.chunks_exact_mut(PITCH)) {
            L::from_slice(from).write(&mut to[b * LANES..]);
        }
    }
}

/// Replaces the outputs `mean` `[4][PITCH]` and `value` `[PITCH]` by the loss's derivatives.
#[inline(always)]
fn differentiate_loss<L: Lane>(
    job: &Job<L::Elem>,
    rows: &[u32],
    mean: &mut [L::Elem],
    value: &mut [L::Elem],
    sums: &mut Sums<L>,
) {
    let (batch, share) = (job.batch, L::of(job.share));
    let log_std = job.network.log_std().map(L::splat);
    for (b, &row) in rows.iter().enumerate() {
        let (at, column) = (row as usize * LANES, |k: usize| k * PITCH + b * LANES);
        let samples = Samples {
            mean: build!(|k| L::from_slice(&mean[column(k)..])),
            log_std,
            value: L::from_slice(&value[column(0)..]),
            z: build!(|k| L::from_slice(&batch.z[at * ACTIONS + k * LANES..])),
            old_log_prob: L::from_slice(&batch.log_prob[at..]),
            advantage: L::from_slice(&batch.advantages[at..]),
            ret: L::from_slice(&batch.returns[at..]),
        };
        let answer = loss(job.weights, &samples, share);
        for k in 0..ACTIONS {
            answer.d_mean[k].write(&mut mean[column(k)..]);
            sums.mean[k] = sums.mean[k] + answer.d_mean[k];
            sums.log_std[k] = sums.log_std[k] + answer.d_log_std[k];
        }
        answer.d_value.write(&mut value[column(0)..]);
        sums.value = sums.value + answer.d_value;
        sums.terms = build!(|k| sums.terms[k] + answer.terms[k]);
    }
}
