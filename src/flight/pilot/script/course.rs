//! Flying at a velocity, straight or in a turn, level or not.

use super::{Now, Script};
use crate::base::rng::Sequence;
use crate::flight::pilot::cascade::Demand;
use nalgebra::Vector3;

/// A velocity for some time.
#[derive(Debug)]
pub struct VelocityLeg {
    speed: f64,
    vertical: f64,
    turn: f64,
    seconds: f64,
    travel: f64,
    heading: f64,
    /// Height that it began at, m.
    height: Option<f64>,
}

/// Error in height to vertical speed, 1/s.
const HEIGHT_GAIN: f64 = 0.8;

impl VelocityLeg {
    /// `speed` over ground and `vertical` (m/s), turning left at `turn` (rad/s), for `seconds`.
    pub fn new(speed: f64, vertical: f64, turn: f64, seconds: f64) -> Self {
        VelocityLeg { speed, vertical, turn, seconds, travel: 0.0, heading: 0.0, height: None }
    }

    /// The same, beginning in the direction `travel` with the nose at `heading`, rad.
    pub fn along(self, travel: f64, heading: f64) -> Self {
        VelocityLeg { travel, heading, ..self }
    }
}

impl Script for VelocityLeg {
    fn demand(&mut self, now: &Now, _: &mut Sequence) -> Option<Demand> {
        if now.time > self.seconds {
            return None;
        }
        let height = *self.height.get_or_insert(now.view.position.z);
        // Only level flight holds its height; a climb that lags behind is still a climb.
        let hold = if self.vertical == 0.0 { HEIGHT_GAIN * (height - now.view.position.z) } else { 0.0 };
        let travel = self.travel + self.turn * now.time;
        let velocity = Vector3::new(self.speed * travel.cos(), self.speed * travel.sin(), self.vertical + hold);
        Some(Demand { heading: Some(self.heading + self.turn * now.time), ..Demand::at(velocity) })
    }
}
