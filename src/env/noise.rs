//! Gaussian noise on what the policy sees and on what it commands, while training.

use crate::check::{Check, Invalid};
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
