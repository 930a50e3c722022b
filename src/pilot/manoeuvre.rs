//! The manoeuvres: each a few seconds, with random sizes.

use super::stabilise::Stabiliser;
use super::{Known, MIDDLE, Seen};
use crate::rng::Sequence;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// What to fly, and what it tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Steps of random size and length on roll or pitch about hover: time constant, rate.
    RollSteps,
    PitchSteps,
    /// Yaw both ways: time constant, rate.
    YawSteps,
    /// A full turn at full rate.
    Flip,
    /// Throttle steps of random size, upright: thrust curve and its time constant.
    ThrottleSteps,
    /// Full throttle, then none.
    Punch,
    /// Throttle slowly from none to full.
    Ramp,
    /// A fast pass with the nose forward, backward or sideways: drag.
    Dash,
    /// Fast up, or down: drag along the thrust.
    Climb,
    Descent,
}

impl Kind {
    /// Every kind, in the order flown; what tells most comes more often.
    pub const ALL: [Kind; 16] = [
        Kind::RollSteps,
        Kind::Dash,
        Kind::PitchSteps,
        Kind::ThrottleSteps,
        Kind::YawSteps,
        Kind::Climb,
        Kind::Flip,
        Kind::Dash,
        Kind::RollSteps,
        Kind::Descent,
        Kind::Punch,
        Kind::Dash,
        Kind::PitchSteps,
        Kind::Ramp,
        Kind::YawSteps,
        Kind::Dash,
    ];
}

/// A manoeuvre under way.
#[derive(Clone, Debug)]
pub struct Manoeuvre {
    kind: Kind,
    since_s: f64,
    pub until_s: f64,
    known: Known,
    /// The step being held, and until when.
    step: f64,
    step_until_s: f64,
    /// Direction of the next step, alternating.
    side: f64,
    /// World velocity of a pass, m/s, and the heading held, rad.
    velocity: [f64; 3],
    heading: f64,
    /// Roll or pitch of a flip: axis, share of full rate, duration of the turn, s.
    flip: (usize, f64, f64),
}

impl Manoeuvre {
    pub fn begin(kind: Kind, seen: &Seen, known: &Known, rng: &mut Sequence) -> Self {
        let side = if rng.unit() < 0.5 { 1.0 } else { -1.0 };
        let mut new = Self {
            kind,
            since_s: seen.time_s,
            until_s: seen.time_s,
            known: *known,
            step: 0.0,
            step_until_s: seen.time_s,
            side,
            velocity: [0.0; 3],
            heading: 0.0,
            flip: (0, side, 0.0),
        };
        let lasts = match kind {
            Kind::RollSteps | Kind::PitchSteps => 1.2,
            Kind::YawSteps => 2.0,
            Kind::ThrottleSteps => 2.5,
            Kind::Punch => 1.6,
            Kind::Ramp => 2.2,
            Kind::Flip => {
                let axis = usize::from(rng.unit() < 0.5);
                let turn = TAU / known.max_rate_rad_s[axis];
                new.flip = (axis, side, turn);
                0.35 + turn
            }
            Kind::Dash => {
                // From one side of the middle to the other.
                let from = [seen.position[0] - MIDDLE[0], seen.position[1] - MIDDLE[1]];
                let away = from[0].hypot(from[1]);
                let course = if away > 10.0 {
                    (-from[1]).atan2(-from[0]) + rng.uniform([-0.5, 0.5])
                } else {
                    rng.uniform([-PI, PI])
                };
                let speed = rng.uniform([8.0, 24.0]);
                new.velocity = [speed * course.cos(), speed * course.sin(), rng.uniform([-2.0, 2.0])];
                // Forward most often, then backward and sideways.
                let turned = [0.0, 0.0, PI, 0.5 * PI, -0.5 * PI, rng.uniform([-PI, PI])];
                new.heading = course + turned[(rng.unit() * turned.len() as f64) as usize];
                rng.uniform([2.5, 4.5])
            }
            Kind::Climb | Kind::Descent => {
                let speed = rng.uniform([5.0, 16.0]);
                let up = if kind == Kind::Climb { speed } else { -0.7 * speed };
                new.velocity = [rng.uniform([-8.0, 8.0]), rng.uniform([-8.0, 8.0]), up];
                new.heading = rng.uniform([-PI, PI]);
                rng.uniform([1.5, 3.0])
            }
        };
        new.until_s += lasts;
        new
    }

    /// The command now.
    pub fn command(&mut self, seen: &Seen, stabiliser: &mut Stabiliser, rng: &mut Sequence) -> [f64; 4] {
        let t = seen.time_s - self.since_s;
        let [roll, pitch, yaw] = stabiliser.turn_to(seen, Vector3::z(), None);
        match self.kind {
            Kind::RollSteps => self.rate_steps(0, seen, stabiliser, rng),
            Kind::PitchSteps => self.rate_steps(1, seen, stabiliser, rng),
            Kind::YawSteps => {
                self.new_step(seen, rng, [0.1, 0.5], |rng| rng.uniform([0.15, 1.15]).min(1.0));
                let [roll, pitch, _, thrust] = stabiliser.velocity(seen, [0.0; 3], None);
                [roll, pitch, self.step, thrust]
            }
            Kind::Flip => {
                let (axis, side, turn) = self.flip;
                if t < 0.3 {
                    // Height first.
                    return [roll, pitch, yaw, 0.9];
                }
                let mut rates = [0.0; 3];
                rates[axis] = if t < 0.3 + turn { side } else { 0.0 };
                [rates[0], rates[1], 0.0, -0.8]
            }
            Kind::ThrottleSteps => {
                // Against the vertical speed, so that the steps stay about one height.
                self.side = if seen.velocity[2] > 2.0 {
                    -1.0
                } else if seen.velocity[2] < -2.0 {
                    1.0
                } else {
                    self.side
                };
                self.new_step(seen, rng, [0.04, 0.25], |rng| rng.unit());
                let hover = self.known.hover;
                let thrust =
                    if self.step > 0.0 { hover + self.step * (1.0 - hover) } else { hover + self.step * (1.0 + hover) };
                [roll, pitch, yaw, thrust]
            }
            Kind::Punch => {
                let thrust = if t < 0.5 {
                    1.0
                } else if t < 1.1 {
                    -1.0
                } else {
                    1.0
                };
                [roll, pitch, yaw, if t < 1.3 { thrust } else { self.known.hover }]
            }
            Kind::Ramp => [roll, pitch, yaw, -1.0 + 2.0 * t / 1.8],
            Kind::Dash | Kind::Climb | Kind::Descent => stabiliser.velocity(seen, self.velocity, Some(self.heading)),
        }
    }

    /// Alternating steps on one axis, short enough not to tumble; the others stay level.
    fn rate_steps(&mut self, axis: usize, seen: &Seen, stabiliser: &mut Stabiliser, rng: &mut Sequence) -> [f64; 4] {
        let full = self.known.max_rate_rad_s[axis];
        if seen.time_s >= self.step_until_s {
            self.side = -self.side;
            let size = rng.uniform([0.1, 1.15]).min(1.0);
            let longest = 0.9 / (size * full);
            self.step = self.side * size;
            self.step_until_s = seen.time_s + rng.uniform([0.03, longest.clamp(0.04, 0.25)]);
        }
        let mut command = stabiliser.velocity(seen, [0.0; 3], None);
        command[axis] = self.step;
        command
    }

    /// Draws the next step when the last is over; its sides alternate.
    fn new_step(&mut self, seen: &Seen, rng: &mut Sequence, lasts_s: [f64; 2], size: impl Fn(&mut Sequence) -> f64) {
        if seen.time_s >= self.step_until_s {
            self.step = self.side * size(rng);
            self.side = -self.side;
            self.step_until_s = seen.time_s + rng.uniform(lasts_s);
        }
    }
}
