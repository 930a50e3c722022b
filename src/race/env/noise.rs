//! Gaussian noise on what the policy sees and on what it commands, while training.

use crate::base::check::{Check, Invalid};
use crate::base::lane::{Lane32, build, each};
use crate::base::rng::{Philox, RngStream, coarse_normals};
use serde::{Deserialize, Serialize};

/// Standard deviations, drawn anew each step; 0 switches one off. More makes a policy more careful and slower.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoiseConfig {
    /// Of each coordinate of the observed position, m.
    pub position_m: f64,
    /// Of each component of the observed velocity, m/s.
    pub velocity_m_s: f64,
    /// Of the observed attitude, about each axis, rad.
    pub attitude_rad: f64,
    /// Of each observed body rate, rad/s.
    pub rate_rad_s: f64,
    /// Of the observed battery voltage, V.
    pub voltage_v: f64,
    /// Of each applied command, in its range of [-1, 1].
    pub action: f64,
}

impl Check for NoiseConfig {
    fn check(&self) -> Result<(), Invalid> {
        for (key, value) in [
            ("position_m", self.position_m),
            ("velocity_m_s", self.velocity_m_s),
            ("attitude_rad", self.attitude_rad),
            ("rate_rad_s", self.rate_rad_s),
            ("voltage_v", self.voltage_v),
            ("action", self.action),
        ] {
            Invalid::unless_not_negative(key, value, "0 switches the noise off")?;
        }
        Ok(())
    }
}

/// One step's error of the state estimate, for a block.
#[derive(Clone, Copy, Debug)]
pub struct Noise<L> {
    /// Position (m), velocity (m/s) and angular rate (rad/s), gate frame.
    pub position: [L; 3],
    pub velocity: [L; 3],
    pub rate: [L; 3],
    /// Attitude: a small rotation vector, gate frame, rad.
    pub attitude: [L; 3],
    /// Battery voltage, V.
    pub voltage: L,
}

#[inline(always)]
fn scaled<L: Lane32, const N: usize>(x: [L; N], sd: f64) -> [L; N] {
    each!(x, |x| x * L::of(sd))
}

/// The estimate's error in `environments` at `step`.
#[inline(always)]
pub fn of_observation<L: Lane32>(c: &NoiseConfig, rng: &Philox, environments: L::Bits, step: u32) -> Noise<L> {
    let w: [[L::Bits; 4]; 2] = build!(|i| rng.noise(RngStream::Noise, environments, step, i as u32));
    // 13 numbers from 7 words.
    let n: [(L, L); 7] = build!(|i| coarse_normals(w[i / 4][i % 4]));
    Noise {
        position: scaled([n[0].0, n[0].1, n[1].0], c.position_m),
        velocity: scaled([n[1].1, n[2].0, n[2].1], c.velocity_m_s),
        rate: scaled([n[3].0, n[3].1, n[4].0], c.rate_rad_s),
        attitude: scaled([n[4].1, n[5].0, n[5].1], c.attitude_rad),
        voltage: n[6].0 * L::of(c.voltage_v),
    }
}

/// What is added to the action in `environments` at `step`.
#[inline(always)]
pub fn of_action<L: Lane32>(c: &NoiseConfig, rng: &Philox, environments: L::Bits, step: u32) -> [L; 4] {
    let w = rng.noise(RngStream::Noise, environments, step, 2);
    let ((a, b), (c0, d)) = (coarse_normals::<L>(w[0]), coarse_normals::<L>(w[1]));
    scaled([a, b, c0, d], c.action)
}
