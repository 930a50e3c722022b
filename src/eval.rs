//! Evaluation: the mean policy on a randomised batch of vehicles.

pub mod evaluation;
pub mod fly;
pub mod score;

use crate::check::{Check, Invalid};
use serde::{Deserialize, Serialize};

/// How a policy is scored (paper section 5.1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvalConfig {
    /// Vehicles; the first is nominal, every other one has all factors drawn.
    pub agents: usize,
    /// Steps of 10 ms after which a flight ends; 1000 as in the paper.
    pub max_steps: usize,
}

impl Check for EvalConfig {
    fn check(&self) -> Result<(), Invalid> {
        Invalid::unless((1..=1_000_000).contains(&self.agents), "agents", self.agents, "1 to 1000000", "")?;
        Invalid::unless((1..=100_000).contains(&self.max_steps), "max_steps", self.max_steps, "1 to 100000", "")
    }
}
