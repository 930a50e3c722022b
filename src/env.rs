//! The race: what a policy sees, what it is paid, when a flight starts and ends.

pub mod noise;
pub mod reset;
pub mod reward;

use crate::check::{Check, Invalid};
use crate::vehicle::randomize::RandomizeConfig;
use noise::NoiseConfig;
use reset::ResetConfig;
use reward::RewardConfig;
use serde::{Deserialize, Serialize};

/// The race as it is trained. Volume and altitude limits are the track's, voltage limits the vehicle's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvConfig {
    /// Steps of 10 ms after which an episode is truncated; it bootstraps from where it was.
    pub horizon_steps: u32,
    /// Longest time without passing a gate, s. Shorter forbids hovering sooner, too short forbids hard gates.
    pub gate_timeout_s: f64,
    /// Aperture radius of physical gates while training, m. Smaller than the track's, so that passing leaves a margin.
    pub gate_radius_m: f64,
    pub noise: NoiseConfig,
    pub reset: ResetConfig,
    pub randomize: RandomizeConfig,
    pub reward: RewardConfig,
}

impl Check for EnvConfig {
    fn check(&self) -> Result<(), Invalid> {
        let steps = self.horizon_steps;
        Invalid::unless((1..=1_000_000).contains(&steps), "horizon_steps", steps, "1 to 1000000", "")?;
        Invalid::unless_positive("gate_timeout_s", self.gate_timeout_s, "")?;
        Invalid::unless_positive("gate_radius_m", self.gate_radius_m, "a gate of no width cannot be passed")?;
        self.noise.check().map_err(|invalid| invalid.within("noise"))?;
        self.reset.check().map_err(|invalid| invalid.within("reset"))?;
        self.randomize.check().map_err(|invalid| invalid.within("randomize"))?;
        self.reward.check().map_err(|invalid| invalid.within("reward"))
    }
}
