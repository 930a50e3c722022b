//! The equations of motion: simulator and diagnosis integrate the same ones.

use super::Extended;
use super::stages::{ForceInputs, TurnError, force};
use crate::base::lane::{Real, build};
use crate::model::attitude::{Quaternion, body_axes, compose, dot, normalized, small_rotation};

/// What moves.
#[derive(Clone, Copy, Debug)]
pub struct RigidBody<R> {
    /// World, m and m/s.
    pub position: [R; 3],
    pub velocity: [R; 3],
    /// Body to world.
    pub attitude: Quaternion<R>,
}

/// What moves it over a short time: [`ForceInputs`] but for what follows from the body itself.
#[derive(Clone, Copy, Debug)]
pub struct Drive<R> {
    /// Filtered thrust command, -1..1.
    pub command: R,
    /// At the terminals, V.
    pub voltage: R,
    /// Body rates, rad/s.
    pub rates: [R; 3],
    /// Over the ground, m.
    pub height: R,
    /// How far the response is behind.
    pub turn_error: TurnError<R>,
    /// Time since the battery was full, s.
    pub elapsed: R,
}

/// The equations of motion: the body `h` seconds later, with forces taken at the middle.
#[inline(always)]
pub fn moved<R: Real>(s: &RigidBody<R>, p: &Extended<R>, drive: &Drive<R>, h: R) -> RigidBody<R> {
    let &Drive { command, voltage, rates, height, turn_error, elapsed } = drive;
    let half = h * R::of(0.5);
    let half_turn = small_rotation(rates, half);
    let middle = compose(s.attitude, half_turn);
    let axes = body_axes(middle);
    let velocity: [R; 3] = build!(|i| dot(axes[i], s.velocity));
    let inputs = ForceInputs { command, voltage, axes, velocity, rates, height, turn_error, elapsed };
    let pushed = force(p, &inputs);
    let acceleration: [R; 3] = build!(|i| {
        let world = axes[0][i].mul_add(pushed[0], axes[1][i].mul_add(pushed[1], axes[2][i] * pushed[2]));
        if i == 2 { world - p.compact.gravity } else { world }
    });
    let velocity: [R; 3] = build!(|i| acceleration[i].mul_add(h, s.velocity[i]));
    RigidBody {
        position: build!(|i| (s.velocity[i] + velocity[i]).mul_add(half, s.position[i])),
        velocity,
        attitude: normalized(compose(middle, half_turn)),
    }
}
