//! Flying on the cushion of air close to the ground.

use super::{Now, Script};
use crate::base::rng::Sequence;
use crate::flight::pilot::cascade::Demand;
use nalgebra::Vector3;

/// A descent to just over the ground, some time there, and a climb.
#[derive(Debug)]
pub struct LowHover {
    height: f64,
    /// When it was there, s.
    there: Option<f64>,
}

/// How near its height counts as there, m, and how long it stays, s.
const NEAR_M: f64 = 0.15;
const STAY_S: f64 = 5.0;
/// Longest descent, s.
const DESCENT_S: f64 = 9.0;
/// Error in height to vertical speed, 1/s, and the fastest descent, m/s.
const HEIGHT_GAIN: f64 = 1.0;
const SINK: f64 = 3.0;
/// Height over the ground at which the climb is over, m.
const CLEAR_M: f64 = 6.0;

impl LowHover {
    /// `height` over the ground (m).
    pub fn new(height: f64) -> Self {
        LowHover { height, there: None }
    }
}

impl Script for LowHover {
    fn demand(&mut self, now: &Now, _: &mut Sequence) -> Option<Demand> {
        let z = now.view.position.z;
        if self.there.is_none() && (z - self.height < NEAR_M || now.time > DESCENT_S) {
            self.there = Some(now.time);
        }
        let over = self.there.is_some_and(|there| now.time > there + STAY_S);
        if over && z > CLEAR_M {
            return None;
        }
        let vertical = if over { SINK } else { (HEIGHT_GAIN * (self.height - z)).max(-SINK) };
        Some(Demand::at(Vector3::new(0.0, 0.0, vertical)))
    }
}
