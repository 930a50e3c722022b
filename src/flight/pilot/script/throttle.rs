//! Random thrust commands about level flight, and turns at full thrust.

use super::{Now, Script};
use crate::base::rng::Sequence;
use crate::flight::pilot::cascade::Demand;
use crate::model::constants::GRAVITY_M_S2;
use rand::RngExt;

/// Random thrust commands, each held for some time.
#[derive(Debug, Default)]
pub struct ThrottleSteps {
    value: f64,
    until: f64,
}

/// How long they go on, s.
const STEPS_S: f64 = 2.8;
/// Shortest and longest time that one is held, s.
const HOLD_S: [f64; 2] = [0.03, 0.4];
/// Vertical speed beyond which steps lead back, m/s, and the most that one step adds.
const DRIFT: f64 = 3.0;
const CHANGE: f64 = 6.0;

impl ThrottleSteps {
    pub fn new() -> Self {
        Self::default()
    }
}

impl Script for ThrottleSteps {
    fn demand(&mut self, now: &Now, rng: &mut Sequence) -> Option<Demand> {
        if now.time > STEPS_S {
            return None;
        }
        if now.time >= self.until {
            let hover = now.limits.hover_command;
            let climb = now.view.velocity.z;
            let up = if climb.abs() > DRIFT { climb < 0.0 } else { rng.random() };
            self.value = rng.uniform(if up { [hover, 1.0] } else { [-1.0, hover] });
            // The thrust curve taken as a line from nothing at -1 through hover.
            let pull = GRAVITY_M_S2 * (self.value - hover).abs() / (1.0 + hover);
            self.until = now.time + rng.uniform(HOLD_S).min(CHANGE / pull.max(0.1)).max(HOLD_S[0]);
        }
        Some(Demand::direct(3, self.value))
    }
}

/// Full thrust while the nose turns to one side and back.
#[derive(Debug)]
pub struct PunchTurns {
    yaw: f64,
    half: f64,
}

/// How long full thrust and its end, an idle, last, s.
const FULL_S: f64 = 0.9;
const IDLE_S: f64 = 0.3;

impl PunchTurns {
    /// Yaw command to the first side, -1..1, and how long each side is held, s.
    pub fn new(yaw: f64, half: f64) -> Self {
        PunchTurns { yaw, half }
    }
}

impl Script for PunchTurns {
    fn demand(&mut self, now: &Now, _: &mut Sequence) -> Option<Demand> {
        if now.time > FULL_S + IDLE_S {
            return None;
        }
        if now.time > FULL_S {
            return Some(Demand::direct(3, -1.0));
        }
        let side = if ((now.time / self.half) as usize).is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut demand = Demand::direct(3, 1.0);
        demand.direct[2] = Some(side * self.yaw);
        Some(demand)
    }
}
