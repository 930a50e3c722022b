//! Proximal policy optimisation (paper sections 4.4 and 4.5), written by hand.
//!
//! Knows nothing of racing: it sees an [`Environment`], and reports to an [`train::Observer`].

mod awake;
pub mod batch;
mod chunk;
pub mod config;
pub mod gae;
pub mod loss;
pub mod rollout;
mod shared_parts;
pub mod squash;
pub mod state;
pub mod train;
pub mod training;
pub mod update;

use crate::base::lane::{Lane, Lane32};

/// What a block of 16 environments answers to an action.
pub struct Step<L: Lane> {
    pub reward: L,
    /// Lanes whose episode ended for good, as bits.
    pub terminated: u16,
    /// Lanes whose episode was cut off by the horizon, as bits; never also terminated.
    pub truncated: u16,
}

/// Sums of what happened in rollouts, merged over tiles in their order.
pub trait Tally: Default + Clone + Send {
    fn merge(&mut self, other: &Self);
}

/// Environments as the learner sees them, 16 at a time.
pub trait Environment: Sync {
    /// 16 environments in registers' form, and as they rest in memory between rollouts.
    type Block<L: Lane32>;
    type Saved: Clone + Send;
    type Tally: Tally;

    /// Numbers in an observation.
    fn observations(&self) -> usize;
    /// Fresh episodes in environments `first..first + 16`.
    fn start(&self, first: u32) -> Self::Saved;
    fn load<L: Lane32>(&self, saved: &Self::Saved) -> Self::Block<L>;
    /// The inverse of [`Environment::load`]; hands what was still being summed up to `tally`.
    fn save<L: Lane32>(&self, block: &Self::Block<L>, tally: &mut Self::Tally) -> Self::Saved;
    /// Writes feature `k` of the 16 lanes to `out[k * stride..k * stride + 16]`.
    fn observe<L: Lane32>(&self, block: &Self::Block<L>, out: &mut [f32], stride: usize);
    /// One step under the squashed action. Ended episodes stay as they ended until [`Environment::reset`].
    fn step<L: Lane32>(&self, block: &mut Self::Block<L>, action: [L; 4], tally: &mut Self::Tally) -> Step<L>;
    /// Begins new episodes in `lanes` (bits).
    fn reset<L: Lane32>(&self, block: &mut Self::Block<L>, lanes: u16, tally: &mut Self::Tally);
    /// The same as it is after so many steps of training, `share` of its budget, with the costs of how an action is
    /// chosen, not of where it leads, at the share `penalties` of their size.
    fn at(&self, steps: u64, share: f64, penalties: f64) -> Self
    where
        Self: Sized;
}
