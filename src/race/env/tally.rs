//! Sums of what happened in rollouts: the raw material of the training log.

use super::reward::TERMS;
use super::terminate::CAUSES;
use crate::learn::ppo;

/// Counts and sums over environment steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RaceTally {
    pub steps: f64,
    /// Sum of each reward term.
    pub terms: [f64; TERMS.len()],
    pub gates: f64,
    /// Laps: every `gates of the track` passes after the first.
    pub laps: f64,
    /// Ended episodes by cause, and those cut off by the horizon.
    pub causes: [f64; CAUSES.len()],
    pub truncated: f64,
    /// Of the ended episodes: reward, gates passed and steps of each, in order of ending.
    pub returns: Vec<f32>,
    pub episode_gates: f64,
    pub episode_steps: f64,
}

impl RaceTally {
    /// Episodes ended.
    pub fn episodes(&self) -> f64 {
        self.returns.len() as f64
    }
}

impl ppo::Tally for RaceTally {
    fn merge(&mut self, other: &Self) {
        self.steps += other.steps;
        self.terms.iter_mut().zip(other.terms).for_each(|(a, b)| *a += b);
        self.gates += other.gates;
        self.laps += other.laps;
        self.causes.iter_mut().zip(other.causes).for_each(|(a, b)| *a += b);
        self.truncated += other.truncated;
        self.returns.extend_from_slice(&other.returns);
        self.episode_gates += other.episode_gates;
        self.episode_steps += other.episode_steps;
    }
}
