//! Rate manoeuvres that depend on the attitude: random steps about level flight, and flips.

use super::{Now, Script};
use crate::base::rng::Sequence;
use crate::flight::pilot::cascade::Demand;
use crate::model::constants::CONTROL_S;
use nalgebra::Vector3;
use rand::RngExt;
use std::f64::consts::TAU;

/// Random rates, each held for some commands, so that the response shows at all frequencies.
#[derive(Debug)]
pub struct RateSteps {
    axes: [bool; 3],
    value: [f64; 3],
    /// When the value of each axis ends, s.
    until: [f64; 3],
}

/// How long they go on, s.
const STEPS_S: f64 = 2.2;
/// Commands that one value is held for: short ones are drawn as often as all the longer.
const HOLDS: [f64; 8] = [1.0, 1.0, 2.0, 2.0, 3.0, 4.0, 6.0, 9.0];
/// Largest roll and pitch that a step may lead to, rad.
const TILTED: f64 = 0.6;

impl RateSteps {
    /// Steps of the marked axes, roll, pitch, yaw; the others stay level.
    pub fn new(axes: [bool; 3]) -> Self {
        RateSteps { axes, value: [0.0; 3], until: [0.0; 3] }
    }

    fn draw(&mut self, axis: usize, now: &Now, rng: &mut Sequence) {
        let ticks = HOLDS[rng.random_range(0..HOLDS.len())];
        let seconds = ticks * CONTROL_S;
        let vertical = now.view.vertical();
        let angle = match axis {
            0 => vertical.y.atan2(vertical.z),
            1 => (-vertical.x).atan2(vertical.z),
            _ => 0.0,
        };
        let mut value = rng.uniform([0.25, 1.25]).min(1.0) * if rng.random() { 1.0 } else { -1.0 };
        let turn = value * now.limits.max_rate_rad_s[axis] * seconds;
        if axis < 2 && (angle + turn).abs() > TILTED && turn * angle > 0.0 {
            value = -value;
        }
        let turn = turn.abs();
        // Long and fast at once would lead past the limit on the other side.
        let shorter = if axis < 2 && turn > TILTED + angle.abs() { (TILTED + angle.abs()) / turn } else { 1.0 };
        self.value[axis] = value;
        self.until[axis] = now.time + ((ticks * shorter).ceil() - 0.5) * CONTROL_S;
    }
}

impl Script for RateSteps {
    fn demand(&mut self, now: &Now, rng: &mut Sequence) -> Option<Demand> {
        if now.time > STEPS_S {
            return None;
        }
        let mut demand = Demand::at(Vector3::zeros());
        for axis in (0..3).filter(|&axis| self.axes[axis]).collect::<Vec<_>>() {
            if now.time >= self.until[axis] {
                self.draw(axis, now, rng);
            }
            demand.direct[axis] = Some(self.value[axis]);
        }
        Some(demand)
    }
}

/// A full turn about roll or pitch.
#[derive(Debug)]
pub struct Flip {
    axis: usize,
    rate: f64,
    thrust: f64,
    turned: f64,
}

/// Time in which the rate comes to rest, s.
const STOPPING_S: f64 = 0.03;

impl Flip {
    /// A flip about `axis` at the command `rate`, with the thrust command held at `thrust`.
    pub fn new(axis: usize, rate: f64, thrust: f64) -> Self {
        Flip { axis, rate, thrust, turned: 0.0 }
    }
}

impl Script for Flip {
    fn demand(&mut self, now: &Now, _: &mut Sequence) -> Option<Demand> {
        self.turned += now.view.rates[self.axis] * now.dt;
        let left = TAU - self.turned.abs() - now.view.rates[self.axis].abs() * STOPPING_S;
        // The time limit is for a vehicle that does not turn.
        if left < 0.0 || now.time > 4.0 {
            return None;
        }
        let mut demand = Demand::direct(self.axis, self.rate);
        demand.direct[1 - self.axis] = Some(0.0);
        demand.direct[3] = Some(self.thrust);
        Some(demand)
    }
}
