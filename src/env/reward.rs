//! The reward, term by term (paper section 4.4).

use crate::config::{Check, Invalid};
use serde::{Deserialize, Serialize};

/// Weights of the reward's terms. All are positive; the sign is in the term.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RewardConfig {
    /// Per metre that the distance to the target gate's centre shrinks.
    pub progress: f64,
    /// For each gate passed.
    pub gate: f64,
    /// Cost of a step: pressure on the lap time.
    pub time: f64,
    /// Cost of a step per metre below `altitude_m`.
    pub altitude: f64,
    /// Height below which the altitude cost grows, m.
    pub altitude_m: f64,
    /// Cost of running into the gate time-out.
    pub timeout: f64,
    /// Cost of a step of looking away from the target gate, times (1 - cos angle) exp(-distance / facing_m).
    pub facing: f64,
    /// Distance over which the facing term fades, m.
    pub facing_m: f64,
    /// lambda_da of Eq. 11: cost of the squared change of the squashed sampled action.
    pub action_change: f64,
}

impl Check for RewardConfig {
    fn check(&self) -> Result<(), Invalid> {
        for (key, value) in [
            ("progress", self.progress),
            ("gate", self.gate),
            ("time", self.time),
            ("altitude", self.altitude),
            ("timeout", self.timeout),
            ("facing", self.facing),
            ("action_change", self.action_change),
        ] {
            Invalid::unless(value.is_finite() && value >= 0.0, key, value, "zero or more", "weights are costs or gains; the sign is in the term")?;
        }
        for (key, value) in [("altitude_m", self.altitude_m), ("facing_m", self.facing_m)] {
            Invalid::unless(value.is_finite() && value > 0.0, key, value, "a length above 0 m", "")?;
        }
        Ok(())
    }
}
