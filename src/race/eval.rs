//! Evaluation: the mean policy on a randomised batch of vehicles.

pub mod choose;
pub mod fly;
pub mod pace;
pub mod score;
pub mod sensitivity;
pub mod spread;

use crate::base::check::{Check, Invalid};
use crate::base::lane::Level;
use crate::learn::nn::Network;
use crate::model::track::Track;
use crate::race::env::Race;
use crate::race::env::reset::StartPlace;
use fly::{Flights, TraceStep, fly};
use score::{Benchmark, score};
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

/// The result of an evaluation, one benchmark for each start distribution that was asked for.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Report {
    /// From the start pad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fixed: Option<Benchmark>,
    /// From points along the reset spline.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub random: Option<Benchmark>,
}

/// [`benchmark`] from both start distributions, and the nominal vehicle's flight from the pad.
pub fn both_starts(
    level: Level,
    race: &Race,
    track: &Track,
    network: &Network<f32>,
    config: &EvalConfig,
) -> (Report, Vec<TraceStep>) {
    let (fixed, flights) = benchmark(level, race, track, network, StartPlace::Pad, config);
    let (random, _) = benchmark(level, race, track, network, StartPlace::Spline, config);
    (Report { fixed: Some(fixed), random: Some(random) }, flights.trace)
}

/// Flies and scores `network` on `track` from `place`, on the current rayon pool; `race` is made scored first.
pub fn benchmark(
    level: Level,
    race: &Race,
    track: &Track,
    network: &Network<f32>,
    place: StartPlace,
    config: &EvalConfig,
) -> (Benchmark, Flights) {
    let flights = fly(level, &race.scored(track), network, place, config.agents, config.max_steps as u32);
    (score(track, &flights), flights)
}
