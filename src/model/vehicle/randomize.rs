//! The spread of vehicles that a policy is trained on (paper Table 2).

use crate::base::check::{Check, Invalid};
use crate::base::rng::Sequence;
use crate::model::effects;
use serde::{Deserialize, Serialize};

/// Factors on the nominal parameters that one episode draws (paper Eq. 13, Table 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    pub time_constant: [f64; 4],
    pub max_rate: [f64; 3],
    pub thrust: f64,
    pub drag: f64,
    /// What is added to the parameters of the effects, in their order.
    pub effects: [f64; effects::COUNT],
}

impl Factors {
    /// The nominal vehicle.
    pub const NOMINAL: Factors =
        Factors { time_constant: [1.0; 4], max_rate: [1.0; 3], thrust: 1.0, drag: 1.0, effects: [0.0; effects::COUNT] };
}

/// Ranges `[low, high]`, drawn evenly and independently for each episode. Factors multiply the nominal value; `[1, 1]`
/// switches one off. Mass and gravity stay as they are: mass cannot be told from thrust, and gravity is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RandomizeConfig {
    /// Factors on the four time constants, each drawn for itself.
    pub time_constant: [f64; 2],
    /// Factors on the three maximum rates, each drawn for itself.
    pub max_rate: [f64; 2],
    /// Factor on the thrust.
    pub thrust: [f64; 2],
    /// Factor on the drag.
    pub drag: [f64; 2],
    /// Battery voltage at the start: 0 empty, 1 full.
    pub charge: [f64; 2],
}

impl Check for RandomizeConfig {
    fn check(&self) -> Result<(), Invalid> {
        for (key, range, least) in [
            ("time_constant", self.time_constant, 0.1),
            ("max_rate", self.max_rate, 0.1),
            ("thrust", self.thrust, 0.1),
            ("drag", self.drag, 0.0),
            ("charge", self.charge, 0.0),
        ] {
            Invalid::unless_range(key, range, least, "")?;
        }
        let most = self.charge[1];
        Invalid::unless(most <= 1.0, "charge", most, "at most 1, a full battery", "")
    }
}

impl RandomizeConfig {
    /// Draws all factors of one episode, but those of effects, which are the vehicle's own.
    pub fn draw(&self, rng: &mut Sequence) -> Factors {
        Factors {
            time_constant: std::array::from_fn(|_| rng.uniform(self.time_constant)),
            max_rate: std::array::from_fn(|_| rng.uniform(self.max_rate)),
            thrust: rng.uniform(self.thrust),
            drag: rng.uniform(self.drag),
            effects: Factors::NOMINAL.effects,
        }
    }
}
