//! The box that the pilot flies in, and whether it is about to leave it.

use super::PilotLimits;
use super::view::View;
use crate::model::constants::GRAVITY_M_S2;

/// Farthest from the origin along x and y, m.
pub const REACH_M: f64 = 100.0;
/// Lowest and highest over the origin between take-off and landing, but for what is flown low on purpose, m.
pub const HEIGHT_M: [f64; 2] = [8.0, 80.0];

/// Margins inside the box at which a manoeuvre is broken off, m.
const MARGIN_M: f64 = 8.0;
/// Deceleration over ground to count on, m/s2.
const BRAKING: f64 = 6.0;
/// Time that a vehicle goes on before it begins to brake, s.
const REACTION_S: f64 = 0.35;
/// Time for which thrust goes on after the throttle is closed, s, and the deceleration of a climb with what idle
/// leaves, m/s2.
const CLOSING_S: f64 = 0.09;
const IDLE_SINK: f64 = 0.7 * GRAVITY_M_S2;

/// Whether the vehicle would leave the box unless it is stopped now.
pub fn leaves(view: &View, limits: &PilotLimits) -> bool {
    let (p, v) = (view.position, view.velocity);
    let aside = [0, 1].into_iter().any(|i| {
        let stop = p[i] + v[i] * REACTION_S + v[i] * v[i].abs() / (2.0 * BRAKING);
        // Only where it is going, so that a manoeuvre may lead back in.
        stop.abs() > REACH_M - MARGIN_M && stop * v[i] > 0.0
    });
    aside || lowest(view, limits) < HEIGHT_M[0] + 0.5 * MARGIN_M || highest(view, limits) > HEIGHT_M[1] - MARGIN_M
}

/// Height at which a fall would end with the thrust that there is.
fn lowest(view: &View, limits: &PilotLimits) -> f64 {
    let turning = view.tilt() / limits.max_rate_rad_s[0].min(limits.max_rate_rad_s[1]).min(6.0);
    let time = 0.1 + turning;
    let fall = (GRAVITY_M_S2 * time - view.velocity.z).max(0.0);
    let spare = 2.0 / (1.0 + limits.hover_command) - 1.0;
    let stopping = fall * fall / (2.0 * GRAVITY_M_S2 * (0.6 * spare).max(0.3));
    view.position.z + view.velocity.z * time - 0.5 * GRAVITY_M_S2 * time * time - stopping
}

/// Height at which a climb would end if the throttle were closed now, but for drag.
fn highest(view: &View, limits: &PilotLimits) -> f64 {
    let spare = 2.0 / (1.0 + limits.hover_command) - 1.0;
    let climb = (view.velocity.z + GRAVITY_M_S2 * spare * CLOSING_S).max(0.0);
    view.position.z + climb * climb / (2.0 * IDLE_SINK)
}
