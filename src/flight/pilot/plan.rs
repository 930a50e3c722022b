//! Where a manoeuvre begins, and what is flown there.

use super::PilotLimits;
use super::cascade::Demand;
use super::manoeuvre::Manoeuvre;
use super::script::{
    Flip, LowHover, Now, PunchTurns, RateSteps, Script, Segment, Sequenced, ThrottleSteps, VelocityLeg,
};
use super::view::{View, wrapped};
use crate::base::rng::Sequence;
use nalgebra::{Vector2, Vector3};
use rand::RngExt;
use rand_distr::{Distribution, UnitCircle};
use std::f64::consts::{FRAC_PI_2, PI};

/// A manoeuvre and where it begins.
#[derive(Debug)]
pub struct Plan {
    station: Vector3<f64>,
    heading: Option<f64>,
    /// Whether it leads below the floor of the box.
    pub low: bool,
    pub script: Box<dyn Script>,
}

/// Longest approach, s: where it takes longer, the manoeuvre begins nearby.
const APPROACH_S: f64 = 7.0;
/// Manoeuvres over the spot begin at most so far from the origin, m.
const NEAR_M: f64 = 50.0;
/// Height at which what is flown close to the ground begins, m.
const LOW_M: f64 = 10.0;
/// Highest speed asked for over ground, m/s.
const FASTEST: f64 = 20.0;

impl Plan {
    /// The manoeuvre of this kind after `flown` others of it. The first is flown at full size, and directions
    /// alternate.
    pub fn new(kind: Manoeuvre, flown: usize, view: &View, limits: &PilotLimits, rng: &mut Sequence) -> Self {
        let sign = if flown.is_multiple_of(2) { 1.0 } else { -1.0 };
        let size = ManoeuvreSize { sign, share: if flown == 0 { 1.0 } else { rng.random() } };
        match kind {
            Manoeuvre::RollSteps | Manoeuvre::PitchSteps | Manoeuvre::YawSteps | Manoeuvre::RateSteps => {
                turning(kind, size, view, limits, rng)
            }
            Manoeuvre::RollDoublets | Manoeuvre::PitchDoublets | Manoeuvre::YawDoublets => {
                turning(kind, size, view, limits, rng)
            }
            Manoeuvre::RollFlip | Manoeuvre::PitchFlip | Manoeuvre::YawSpin => turning(kind, size, view, limits, rng),
            Manoeuvre::ThrottleSteps | Manoeuvre::Punch | Manoeuvre::PunchTurns | Manoeuvre::LowHover => {
                pushing(kind, size, view, rng)
            }
            Manoeuvre::Chop | Manoeuvre::RampUp | Manoeuvre::RampDown => pushing(kind, size, view, rng),
            Manoeuvre::Forward | Manoeuvre::Backward | Manoeuvre::Left | Manoeuvre::Right => {
                travelling(kind, size, view, rng)
            }
            Manoeuvre::Climb | Manoeuvre::Descent | Manoeuvre::Dive | Manoeuvre::Circle => {
                travelling(kind, size, view, rng)
            }
        }
    }

    /// Flies to the station; `None` when there.
    pub fn approach(&self, now: &Now) -> Option<Demand> {
        let view = now.view;
        let way = self.station - view.position;
        let turned = self.heading.map_or(0.0, |heading| wrapped(heading - view.heading()).abs());
        let there = way.xy().norm() < 12.0 && way.z.abs() < 5.0 && turned < 0.25;
        let calm = view.velocity.norm() < 3.5 && view.tilt() < 0.3 && view.rates.norm() < 0.8;
        if calm && (there || now.time > APPROACH_S) {
            return None;
        }
        let over_ground = (way.xy() * 0.9).cap_magnitude(12.0);
        // Braking takes part of the way, and the last of the speed is given up at once.
        let over_ground = if way.xy().norm() < 8.0 { Vector2::zeros() } else { over_ground };
        let vertical = if way.z.abs() < 3.0 { 0.0 } else { (0.9 * way.z).clamp(-8.0, 9.0) };
        let velocity = Vector3::new(over_ground.x, over_ground.y, vertical);
        Some(Demand { heading: self.heading, ..Demand::at(velocity) })
    }
}

/// How large a manoeuvre is, and to which side.
#[derive(Clone, Copy)]
struct ManoeuvreSize {
    sign: f64,
    /// 0 to 1, between the least that is worth it and the whole.
    share: f64,
}

impl ManoeuvreSize {
    /// Between `low` and 1.
    fn least(self, low: f64) -> f64 {
        low + (1.0 - low) * self.share
    }

    fn signed(self, low: f64) -> f64 {
        self.sign * self.least(low)
    }
}

/// Steps, doublets, flips and spins of body rates, over the spot.
fn turning(kind: Manoeuvre, size: ManoeuvreSize, view: &View, limits: &PilotLimits, rng: &mut Sequence) -> Plan {
    match kind {
        Manoeuvre::RollSteps | Manoeuvre::PitchSteps | Manoeuvre::YawSteps | Manoeuvre::RateSteps => {
            let axis = kind as usize;
            let axes: [bool; 3] = std::array::from_fn(|i| axis == i || axis == 3);
            over_spot(view, rng.uniform([25.0, 60.0]), Box::new(RateSteps::new(axes)))
        }
        Manoeuvre::RollDoublets | Manoeuvre::PitchDoublets | Manoeuvre::YawDoublets => {
            let axis = kind as usize - Manoeuvre::RollDoublets as usize;
            let script = Sequenced::doublets(axis, size.sign, limits, rng);
            over_spot(view, rng.uniform([25.0, 60.0]), Box::new(script))
        }
        Manoeuvre::RollFlip | Manoeuvre::PitchFlip => {
            let axis = kind as usize - Manoeuvre::RollFlip as usize;
            let script = Flip::new(axis, size.signed(0.85), rng.uniform([-1.0, limits.hover_command]));
            over_spot(view, rng.uniform([38.0, 60.0]), Box::new(script))
        }
        // A yaw spin.
        _ => {
            let rate = size.signed(0.5);
            let spin = |rate: f64| Segment { seconds: 0.9, command: Some([rate, rate]) };
            over_spot(view, rng.uniform([25.0, 60.0]), Box::new(Sequenced::new(2, vec![spin(rate), spin(-rate)])))
        }
    }
}

/// What throttle does, over the spot.
fn pushing(kind: Manoeuvre, size: ManoeuvreSize, view: &View, rng: &mut Sequence) -> Plan {
    match kind {
        Manoeuvre::ThrottleSteps => over_spot(view, rng.uniform([35.0, 50.0]), Box::new(ThrottleSteps::new())),
        Manoeuvre::Punch => {
            let seconds = rng.uniform([0.3, 1.0]);
            over_spot(view, rng.uniform([16.0, 26.0]), throttle(&[(seconds, 1.0, 1.0), (0.3, -1.0, -1.0)]))
        }
        Manoeuvre::PunchTurns => {
            let script = PunchTurns::new(size.signed(0.6), rng.uniform([0.15, 0.3]));
            over_spot(view, rng.uniform([16.0, 24.0]), Box::new(script))
        }
        Manoeuvre::LowHover => {
            let script = LowHover::new(rng.uniform([0.2, 0.35]));
            Plan { low: true, ..over_spot(view, LOW_M, Box::new(script)) }
        }
        Manoeuvre::Chop => {
            let seconds = rng.uniform([0.5, 1.6]);
            over_spot(view, rng.uniform([58.0, 68.0]), throttle(&[(seconds, -1.0, -1.0), (0.2, 1.0, 1.0)]))
        }
        Manoeuvre::RampUp => {
            over_spot(view, rng.uniform([38.0, 48.0]), throttle(&[(rng.uniform([0.8, 2.0]), -1.0, 1.0)]))
        }
        // A ramp down.
        _ => over_spot(view, rng.uniform([18.0, 28.0]), throttle(&[(rng.uniform([0.8, 2.0]), 1.0, -1.0)])),
    }
}

/// Passes, climbs, descents and circles.
fn travelling(kind: Manoeuvre, size: ManoeuvreSize, view: &View, rng: &mut Sequence) -> Plan {
    match kind {
        Manoeuvre::Forward | Manoeuvre::Backward | Manoeuvre::Left | Manoeuvre::Right => {
            let nose = match kind {
                Manoeuvre::Forward => 0.0,
                Manoeuvre::Backward => PI,
                Manoeuvre::Left => FRAC_PI_2,
                _ => -FRAC_PI_2,
            };
            let speed = FASTEST * size.least(0.7);
            let height = rng.uniform([22.0, 58.0]);
            across(view, height, nose, rng, VelocityLeg::new(speed, 0.0, 0.0, 3.2))
        }
        Manoeuvre::Climb | Manoeuvre::Descent => {
            let (height, vertical) = match kind {
                Manoeuvre::Climb => (14.0, 18.0 * size.least(0.5)),
                _ => (70.0, -14.0 * size.least(0.3)),
            };
            let aside = rng.uniform([0.0, 6.0]);
            across(view, height, 0.0, rng, VelocityLeg::new(aside, vertical, 0.0, 3.8))
        }
        Manoeuvre::Dive => {
            let (speed, vertical) = (FASTEST * size.least(0.5), -rng.uniform([5.0, 12.0]));
            across(view, 66.0, 0.0, rng, VelocityLeg::new(speed, vertical, 0.0, 3.2))
        }
        // A circle.
        _ => {
            let (speed, radius) = (rng.uniform([10.0, 16.0]), rng.uniform([18.0, 28.0]));
            let turn = size.sign * speed / radius;
            across(view, rng.uniform([25.0, 55.0]), 0.0, rng, VelocityLeg::new(speed, 0.0, turn, 4.0))
        }
    }
}

fn over_spot(view: &View, height: f64, script: Box<dyn Script>) -> Plan {
    let spot = view.position.xy().cap_magnitude(NEAR_M);
    Plan { station: Vector3::new(spot.x, spot.y, height), heading: None, low: false, script }
}

fn throttle(segments: &[(f64, f64, f64)]) -> Box<dyn Script> {
    let segments = segments.iter().map(|&(seconds, from, to)| Segment { seconds, command: Some([from, to]) });
    Box::new(Sequenced::new(3, segments.collect()))
}

/// Away over the origin, with the direction of travel `nose` radians to the left of the nose.
fn across(view: &View, height: f64, nose: f64, rng: &mut Sequence, course: VelocityLeg) -> Plan {
    let here = view.position.xy();
    let away = if here.norm() > 5.0 { here.normalize() } else { Vector2::from(UnitCircle.sample(rng)) };
    let spot = away * here.norm().clamp(20.0, 60.0);
    let travel = (-away.y).atan2(-away.x);
    let heading = travel - nose;
    let script = Box::new(course.along(travel, heading));
    Plan { station: Vector3::new(spot.x, spot.y, height), heading: Some(heading), low: false, script }
}
