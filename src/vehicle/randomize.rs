//! The spread of vehicles that a policy is trained on (paper Table 2).

use crate::check::{Check, Invalid};
use crate::dynamics::Factors;
use crate::rng::Sequence;
use crate::vehicle::Vehicle;
use serde::{Deserialize, Serialize};

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
    /// Battery voltage at the start, V.
    pub voltage_v: [f64; 2],
}

impl Check for RandomizeConfig {
    fn check(&self) -> Result<(), Invalid> {
        for (key, range, least) in [
            ("time_constant", self.time_constant, 0.1),
            ("max_rate", self.max_rate, 0.1),
            ("thrust", self.thrust, 0.1),
            ("drag", self.drag, 0.0),
            ("voltage_v", self.voltage_v, 0.0),
        ] {
            Invalid::unless_range(key, range, least, "")?;
        }
        Ok(())
    }
}

impl RandomizeConfig {
    /// The same spread for `other` in place of `vehicle`, with batteries as full as these would be.
    pub fn charged_as(&self, vehicle: &Vehicle, other: &Vehicle) -> Self {
        let (from, to) = (&vehicle.battery, &other.battery);
        if (from.full_v, from.empty_v) == (to.full_v, to.empty_v) {
            return self.clone();
        }
        let scale = (to.full_v - to.empty_v) / (from.full_v - from.empty_v);
        let voltage_v = self.voltage_v.map(|v| to.empty_v + (v - from.empty_v) * scale);
        Self { voltage_v, ..self.clone() }
    }

    /// Draws all factors of one episode.
    pub fn draw(&self, rng: &mut Sequence) -> Factors {
        Factors {
            time_constant: std::array::from_fn(|_| rng.uniform(self.time_constant)),
            max_rate: std::array::from_fn(|_| rng.uniform(self.max_rate)),
            thrust: rng.uniform(self.thrust),
            drag: rng.uniform(self.drag),
        }
    }
}
