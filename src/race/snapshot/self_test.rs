//! Observations and the answers to them, kept with a policy, so that whoever loads it can tell that it still works.

use crate::base::check::Invalid;
use crate::base::rng::{Philox, Stream};
use crate::learn::nn::Network;
use crate::race::act::act;
use crate::race::env::observe::OBSERVATIONS;

/// Observations kept.
pub const SAMPLES: usize = 8;
/// Largest difference of an action between one CPU and another.
const TOLERANCE: f32 = 1e-4;

/// Observations `[8][observations]`, drawn evenly over their usual range of -1 to 1, and actions `[8][4]`.
pub fn vectors(network: &Network<f32>) -> (Vec<f32>, Vec<f32>) {
    let mut rng = Philox::new(0).sequence(Stream::Evaluation, 0, 0);
    let observations: Vec<f32> = (0..SAMPLES * OBSERVATIONS).map(|_| rng.uniform([-1.0, 1.0]) as f32).collect();
    let actions = actions(network, &observations);
    (observations, actions)
}

/// Whether `network` answers `observations` with `expected`.
pub fn check(network: &Network<f32>, observations: &[f32], expected: &[f32]) -> Result<(), Invalid> {
    let found = actions(network, observations);
    let worst = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let complaint = format!("actions that differ by {worst} from those the policy gave when it was written");
    Invalid::unless(worst <= TOLERANCE, "self_test.action", complaint, "", "the file is damaged; use another copy")
}

/// Squashed mean actions `[8][4]`.
fn actions(network: &Network<f32>, observations: &[f32]) -> Vec<f32> {
    let (observations, _) = observations.as_chunks();
    act(network, observations).concat()
}
