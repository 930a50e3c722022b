//! A tile's work in parts that can be timed alone.

use super::{Job, PITCH, Sums, TILE_ROWS, Worker, differentiate_loss, gather};
use crate::base::lane::{LANES, Lane, Lane32};
use crate::learn::nn::gemm::Precision;
use crate::learn::nn::mlp;
use crate::learn::policy::ACTIONS;
use crate::learn::ppo::loss::TERMS;

/// What is done of the tiles of a minibatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TilePart {
    Gather,
    Forward,
    /// The backward pass destroys what the forward pass left, so that it cannot be repeated alone.
    ForwardAndBackward,
    Loss,
}

/// Does `part` of all tiles of `rows`; its results are of no use.
#[inline(always)]
pub fn run<L: Lane32, P: Precision<L>>(
    part: TilePart,
    job: &Job<f32>,
    rows: &[u32],
    worker: &mut Worker<f32>,
    gradient: &mut [f32],
) {
    let zero = L::zero();
    let mut sums = Sums { terms: [zero; TERMS.len()], mean: [zero; ACTIONS], log_std: [zero; ACTIONS], value: zero };
    for rows in rows.chunks(TILE_ROWS) {
        L::vectorize(
            #[inline(always)]
            || tile::<L, P>(part, job, rows, worker, &mut sums, gradient),
        );
    }
    std::hint::black_box(sums.value.sum());
}

#[inline(always)]
fn tile<L: Lane<Elem = f32>, P: Precision<L>>(
    part: TilePart,
    job: &Job<f32>,
    rows: &[u32],
    worker: &mut Worker<f32>,
    sums: &mut Sums<L>,
    gradient: &mut [f32],
) {
    let Worker { x, actor, critic, mean, value, turned } = worker;
    let (network, samples) = (job.network, rows.len() * LANES);
    let p = &network.parameters;
    match part {
        TilePart::Gather => return gather::<L>(job.batch.observations, network.inputs(), rows, x),
        TilePart::Loss => return differentiate_loss::<L>(job, rows, mean, value, sums),
        TilePart::Forward | TilePart::ForwardAndBackward => {}
    }
    mlp::forward::<L, P>(&network.actor, p, samples, PITCH, x, actor, mean);
    mlp::forward::<L, P>(&network.critic, p, samples, PITCH, x, critic, value);
    if part == TilePart::ForwardAndBackward {
        mlp::backward::<L, P>(&network.actor, p, &turned[0], samples, PITCH, x, actor, mean, gradient);
        mlp::backward::<L, P>(&network.critic, p, &turned[1], samples, PITCH, x, critic, value, gradient);
    }
}
