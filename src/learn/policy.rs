//! The tanh-Gaussian policy: a = tanh(z), z normal about the network's mean with a state-independent spread.

use crate::base::lane::{Real, build};

/// Commands: roll, pitch and yaw rate, collective thrust.
pub const ACTIONS: usize = 4;

const HALF_LOG_TAU: f64 = 0.918_938_533_204_672_7;

/// Draws `z = mean + exp(log_std) noise` and returns it with its log-probability. The density is that of z: the
/// squashing changes the density of a by a factor that cancels in PPO's ratio.
#[inline(always)]
pub fn sample<R: Real>(mean: [R; ACTIONS], log_std: [R; ACTIONS], noise: [R; ACTIONS]) -> ([R; ACTIONS], R) {
    let z = build!(|k| log_std[k].exp().mul_add(noise[k], mean[k]));
    (z, log_prob_of(noise, log_std))
}

/// Log-probability of a z that lies `noise` standard deviations from the mean, per command.
#[inline(always)]
pub fn log_prob_of<R: Real>(noise: [R; ACTIONS], log_std: [R; ACTIONS]) -> R {
    let mut sum = R::of(-(ACTIONS as f64) * HALF_LOG_TAU);
    for k in 0..ACTIONS {
        sum = (noise[k] * R::of(-0.5)).mul_add(noise[k], sum - log_std[k]);
    }
    sum
}

/// Entropy of z, summed over the commands.
pub fn entropy(log_std: [f64; ACTIONS]) -> f64 {
    log_std.iter().map(|s| s + 0.5 + HALF_LOG_TAU).sum()
}
