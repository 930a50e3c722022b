//! What an optimiser step costs, part by part: each is repeated alone, on the calling thread.

use super::span::spans;
use super::{CHUNK_ROWS, Hyper, POISONED, Updater};
use crate::base::lane::{Kernel, LANES, Lane32, Level, Portable, dispatch};
use crate::base::stopwatch::best;
use crate::learn::nn::aligned::Aligned;
use crate::learn::nn::bf16::Bf16;
use crate::learn::nn::gemm::Exact;
use crate::learn::nn::{HIDDEN, Network};
use crate::learn::ppo::batch::Minibatch;
use crate::learn::ppo::chunk::parts::{self, TilePart};
use crate::learn::ppo::chunk::{Chunk, Job, Worker};
use crate::learn::ppo::config::ProductPrecision;
use std::time::Duration;

/// Seconds of the parts of one step. They are measured apart, so that they add up to the step only about.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepParts {
    /// The step itself, on the current pool.
    pub whole: f64,
    /// Copying the minibatch's observations side by side.
    pub gather: f64,
    /// Both networks: products, tanh and heads.
    pub forward: f64,
    /// The forward pass's tanh alone, from memory to memory; in `forward` it is done on registers.
    pub tanh: f64,
    pub loss: f64,
    pub backward: f64,
    /// Transposes of the second layers' weights.
    pub transpose: f64,
    /// Sum of the chunks' gradients, and its norm.
    pub sum: f64,
    pub adam: f64,
    /// Chunks that threads can share.
    pub chunks: usize,
}

impl StepParts {
    /// What threads share whatever the number of chunks.
    pub fn spanned(&self) -> f64 {
        self.sum + self.adam
    }

    /// What threads share a chunk at a time.
    pub fn chunked(&self) -> f64 {
        (self.whole - self.transpose - self.spanned()).max(0.0)
    }
}

/// What can be repeated alone.
#[derive(Clone, Copy)]
enum StepPart {
    Tile(TilePart),
    Tanh,
    Transpose,
    Sum,
    Adam,
}

/// Measures for about `time`. `network` and the optimiser are changed.
pub fn measure(
    updater: &mut Updater<f32>,
    level: Level,
    network: &mut Network<f32>,
    batch: &Minibatch<f32>,
    rows: &[u32],
    hyper: &Hyper,
    time: Duration,
) -> StepParts {
    let each = time / 9;
    let whole = best(each, || updater.step(level, network, batch, rows, hyper));
    let mut worker = Worker::new(network);
    let mut chunk = Chunk::new(network);
    worker.turn::<Portable<f32>>(network);
    let mut hidden = Aligned::zeros(4 * HIDDEN * rows.len() * LANES);
    let share = 1.0 / (rows.len() * LANES) as f64;
    let mut one = |part: StepPart| {
        best(each, || {
            let at = PartAt { batch, rows, hyper, share, hidden: &mut hidden, worker: &mut worker };
            dispatch(level, RunPart { part, at, updater, network, gradient: &mut chunk.gradient })
        })
    };
    let [transpose, gather, forward] =
        [StepPart::Transpose, StepPart::Tile(TilePart::Gather), StepPart::Tile(TilePart::Forward)].map(&mut one);
    StepParts {
        whole,
        gather,
        forward,
        tanh: one(StepPart::Tanh),
        loss: one(StepPart::Tile(TilePart::Loss)),
        backward: one(StepPart::Tile(TilePart::ForwardAndBackward)) - forward,
        transpose,
        sum: one(StepPart::Sum),
        adam: one(StepPart::Adam),
        chunks: rows.len().div_ceil(CHUNK_ROWS),
    }
}

struct PartAt<'a> {
    batch: &'a Minibatch<'a, f32>,
    rows: &'a [u32],
    hyper: &'a Hyper,
    share: f64,
    hidden: &'a mut [f32],
    worker: &'a mut Worker<f32>,
}

struct RunPart<'a> {
    part: StepPart,
    at: PartAt<'a>,
    updater: &'a mut Updater<f32>,
    network: &'a mut Network<f32>,
    gradient: &'a mut [f32],
}

impl Kernel for RunPart<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        let Self { part, at, updater, network, gradient } = self;
        let PartAt { batch, rows, hyper, share, hidden, worker } = at;
        match part {
            StepPart::Tile(part) => {
                let job = Job { network, batch, weights: &hyper.weights, share };
                match hyper.precision {
                    ProductPrecision::F32 => parts::run::<L, Exact>(part, &job, rows, worker, gradient),
                    ProductPrecision::Bf16 => parts::run::<L, Bf16>(part, &job, rows, worker, gradient),
                }
            }
            StepPart::Tanh => L::vectorize(
                #[inline(always)]
                || hidden.chunks_exact_mut(LANES).for_each(|h| L::from_slice(h).tanh().write(h)),
            ),
            StepPart::Transpose => worker.turn::<L>(network),
            StepPart::Sum | StepPart::Adam => {
                let Updater { adam, gradient, next, chunks, .. } = updater;
                let rates = adam.advance(hyper.learning_rate, hyper.adam_epsilon);
                let mut all = spans(1, gradient, adam, next);
                let span = all[0].get_mut().expect(POISONED);
                if matches!(part, StepPart::Adam) {
                    return span.descend::<L>(&rates, &network.parameters, 1.0);
                }
                for (number, chunk) in chunks.iter_mut().enumerate() {
                    span.add::<L>(number, &chunk.get_mut().expect(POISONED).gradient);
                }
                std::hint::black_box(span.squares(L::zero()).sum());
            }
        }
    }
}
