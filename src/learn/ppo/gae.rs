//! Generalised advantage estimation (Schulman et al., 2016) with termination and truncation told apart.

use crate::base::lane::{Kernel, LANES, Lane32, Level, Mask, dispatch};

/// A rollout of `T` steps of `blocks` blocks; row `t * blocks + b`.
pub struct Steps<'a> {
    pub blocks: usize,
    /// `[rows][16]`
    pub rewards: &'a [f32],
    pub values: &'a [f32],
    /// A bit per lane, `[rows]`.
    pub terminated: &'a [u16],
    pub truncated: &'a [u16],
    /// The critic at a truncated episode's own last observation, `[rows][16]`; used only there.
    pub final_values: &'a [f32],
    /// The critic after the last step, `[blocks][16]`.
    pub last_values: &'a [f32],
}

/// Writes advantages and returns (advantage + value), `[rows][16]`.
///
/// delta_t = r_t + gamma v_(t+1) - v_t; A_t = delta_t + gamma lambda A_(t+1). After a termination nothing follows;
/// after a truncation v_(t+1) is the critic at the episode's own last observation, and the sum stops.
pub fn advantages(level: Level, steps: &Steps, gamma: f32, lambda: f32, advantages: &mut [f32], returns: &mut [f32]) {
    dispatch(level, Backwards { steps, gamma, lambda, advantages, returns });
}

struct Backwards<'a> {
    steps: &'a Steps<'a>,
    gamma: f32,
    lambda: f32,
    advantages: &'a mut [f32],
    returns: &'a mut [f32],
}

impl Kernel for Backwards<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        let Backwards { steps, gamma, lambda, advantages, returns } = self;
        let (gamma, decay) = (L::splat(gamma), L::splat(gamma * lambda));
        for block in 0..steps.blocks {
            let mut next_value = L::from_slice(&steps.last_values[block * LANES..]);
            let mut next_advantage = L::zero();
            for row in (block..steps.terminated.len()).step_by(steps.blocks).rev() {
                let at = row * LANES;
                let terminated = L::Mask::from_bits(steps.terminated[row].into());
                let truncated = L::Mask::from_bits(steps.truncated[row].into());
                let future = L::select(truncated, L::from_slice(&steps.final_values[at..]), next_value);
                let future = L::select(terminated, L::zero(), future);
                let tail = L::select(terminated | truncated, L::zero(), next_advantage);
                let value = L::from_slice(&steps.values[at..]);
                let delta = gamma.mul_add(future, L::from_slice(&steps.rewards[at..])) - value;
                next_advantage = decay.mul_add(tail, delta);
                next_value = value;
                next_advantage.write(&mut advantages[at..]);
                (next_advantage + value).write(&mut returns[at..]);
            }
        }
    }
}

/// Shifts and scales to mean 0 and standard deviation 1 over the batch, summed in order in double precision.
pub fn normalise(advantages: &mut [f32]) {
    let n = advantages.len() as f64;
    let mean = advantages.iter().map(|&a| f64::from(a)).sum::<f64>() / n;
    let variance = advantages.iter().map(|&a| (f64::from(a) - mean).powi(2)).sum::<f64>() / n;
    let (mean, scale) = (mean as f32, (1.0 / (variance.sqrt() + 1e-8)) as f32);
    advantages.iter_mut().for_each(|a| *a = (*a - mean) * scale);
}
