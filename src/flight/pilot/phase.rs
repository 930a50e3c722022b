//! What the pilot is doing: resting, climbing, on its way, flying a manoeuvre, landing.

use super::cascade::Demand;
use super::plan::Plan;
use super::script::Now;
use super::view::View;
use super::{PilotLimits, bounds};
use crate::base::rng::Sequence;
use nalgebra::Vector3;

/// Time on the ground before taking off, s.
const GROUND_S: f64 = 2.0;
/// Height at which the first manoeuvre is planned, m.
const TAKEN_OFF_M: f64 = 12.0;
/// Time kept for the landing, s.
const LANDING_S: f64 = 16.0;
/// Height over the ground at which the throttle is closed, m.
const TOUCH_M: f64 = 0.15;

/// See the module.
#[derive(Debug)]
pub enum PilotPhase {
    Ground,
    TakeOff,
    /// On the way to where the manoeuvre begins.
    Approach(Plan),
    Manoeuvre(Plan),
    Landing,
    Landed,
}

/// Whether it is time to land.
pub fn is_over(view: &View, limits: &PilotLimits) -> bool {
    view.time > limits.seconds - LANDING_S || view.voltage < limits.empty_v
}

impl PilotPhase {
    /// What the phase asks for, `Some(None)` for resting on the ground, or `None` where it is over.
    pub fn demand(&mut self, now: &Now, rng: &mut Sequence) -> Option<Option<Demand>> {
        let view = now.view;
        let over = is_over(view, now.limits);
        let demand = match self {
            PilotPhase::Ground if now.time < GROUND_S => return Some(None),
            PilotPhase::Ground => None,
            PilotPhase::Landed => return Some(None),
            PilotPhase::Landing if view.position.z < TOUCH_M => None,
            PilotPhase::Landing => Some(Demand::at(Vector3::new(0.0, 0.0, -(0.5 + 0.4 * view.position.z).min(9.0)))),
            _ if over => None,
            PilotPhase::TakeOff if view.position.z > TAKEN_OFF_M => None,
            PilotPhase::TakeOff => Some(Demand::at(Vector3::new(0.0, 0.0, 4.0))),
            PilotPhase::Approach(plan) => plan.approach(now),
            PilotPhase::Manoeuvre(plan) if !plan.low && bounds::leaves(view, now.limits) => None,
            PilotPhase::Manoeuvre(plan) => plan.script.demand(now, rng),
        };
        demand.map(Some)
    }
}
