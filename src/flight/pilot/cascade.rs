//! From a wanted velocity over attitude to commands, with a rough idea of the thrust.

use super::PilotLimits;
use super::view::{View, wrapped};
use crate::model::constants::GRAVITY_M_S2;
use nalgebra::Vector3;

/// What to fly.
#[derive(Clone, Copy, Debug)]
pub struct Demand {
    /// World, m/s.
    pub velocity: Vector3<f64>,
    /// Direction of the nose over ground, rad; none keeps the yaw rate at zero.
    pub heading: Option<f64>,
    /// Commands that replace the cascade's own.
    pub direct: [Option<f64>; 4],
}

impl Demand {
    /// Flies at `velocity`.
    pub fn at(velocity: Vector3<f64>) -> Self {
        Demand { velocity, heading: None, direct: [None; 4] }
    }

    /// Command `axis` held at `value`; the others level the vehicle and stop it.
    pub fn direct(axis: usize, value: f64) -> Self {
        let mut demand = Self::at(Vector3::zeros());
        demand.direct[axis] = Some(value);
        demand
    }
}

/// Velocity error to acceleration, over ground and vertical, 1/s.
const VELOCITY_GAIN: [f64; 2] = [2.0, 3.0];
/// Velocity error to change of the standing acceleration, over ground and vertical, 1/s2.
const INTEGRAL_GAIN: [f64; 2] = [1.0, 1.5];
/// Attitude and heading error to body rate, 1/s.
const ATTITUDE_GAIN: f64 = 8.0;
const HEADING_GAIN: f64 = 3.0;
/// Tangent of the steepest tilt while flying by velocity.
const STEEPEST: f64 = 2.1;

/// The controller and what it has learned of drag and thrust.
#[derive(Debug)]
pub struct Cascade {
    max_rate: [f64; 3],
    hover: f64,
    /// Acceleration that errors have asked for so far, world, m/s2.
    standing: Vector3<f64>,
}

impl Cascade {
    pub fn new(limits: &PilotLimits) -> Self {
        let hover = limits.hover_command.clamp(-0.9, 0.6);
        Self { max_rate: limits.max_rate_rad_s, hover, standing: Vector3::zeros() }
    }

    /// Forgets what held only for the manoeuvre before.
    pub fn settle(&mut self) {
        self.standing.x = 0.0;
        self.standing.y = 0.0;
    }

    /// The command that leads toward `demand`; `dt` is the time since the last one, s.
    pub fn command(&mut self, view: &View, demand: &Demand, dt: f64) -> [f64; 4] {
        let wanted = self.specific_force(view, demand, dt);
        let along = wanted.dot(&view.up());
        let thrust = -1.0 + (1.0 + self.hover) * along / GRAVITY_M_S2;

        let rates = toward(view, wanted) * ATTITUDE_GAIN;
        let (mut roll, mut pitch) = (rates.x / self.max_rate[0], rates.y / self.max_rate[1]);
        // Both shrink together, so that the axis of the turn stays.
        let most = roll.abs().max(pitch.abs()).max(1.0);
        (roll, pitch) = (roll / most, pitch / most);
        // Upside down the heading means nothing.
        let heading = demand.heading.filter(|_| view.up().z > 0.3);
        let yaw = heading.map_or(0.0, |h| HEADING_GAIN * wrapped(h - view.heading()) / self.max_rate[2]);

        let own = [roll, pitch, yaw, thrust];
        std::array::from_fn(|i| demand.direct[i].unwrap_or(own[i]).clamp(-1.0, 1.0))
    }

    /// Thrust over mass that is wanted, world.
    fn specific_force(&mut self, view: &View, demand: &Demand, dt: f64) -> Vector3<f64> {
        let error = demand.velocity - view.velocity;
        let by_attitude = demand.direct[..2].iter().all(Option::is_none);
        if demand.direct[3].is_none() && by_attitude && error.z.abs() < 3.0 {
            self.standing.z = (self.standing.z + INTEGRAL_GAIN[1] * error.z * dt).clamp(-8.0, 8.0);
        }
        if by_attitude && error.xy().norm() < 8.0 {
            let over_ground = self.standing.xy() + error.xy() * INTEGRAL_GAIN[0] * dt;
            self.standing.fixed_rows_mut::<2>(0).copy_from(&over_ground.cap_magnitude(12.0));
        }
        // The thrust curve taken as a line from nothing at -1 through hover.
        let strongest = 0.85 * 2.0 * GRAVITY_M_S2 / (1.0 + self.hover);
        let vertical = VELOCITY_GAIN[1] * error.z + self.standing.z;
        let vertical = GRAVITY_M_S2
            + vertical.clamp(-0.75 * GRAVITY_M_S2, 0.8 * (strongest - GRAVITY_M_S2).max(0.1 * GRAVITY_M_S2));
        let room = (strongest.powi(2) - vertical.powi(2)).max(0.1 * GRAVITY_M_S2).sqrt().min(STEEPEST * vertical);
        let over_ground = (error.xy() * VELOCITY_GAIN[0] + self.standing.xy()).cap_magnitude(room);
        Vector3::new(over_ground.x, over_ground.y, vertical)
    }
}

/// The rotation that brings body z along `wanted` the short way, body frame, rad.
fn toward(view: &View, wanted: Vector3<f64>) -> Vector3<f64> {
    let there = view.attitude.inverse() * wanted.normalize();
    let axis = Vector3::new(-there.y, there.x, 0.0);
    let sine = axis.norm();
    if sine < 1e-6 {
        return if there.z > 0.0 { Vector3::zeros() } else { Vector3::x() * std::f64::consts::PI };
    }
    axis * (sine.atan2(there.z) / sine)
}
