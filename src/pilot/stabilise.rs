//! Holding a velocity, or just an attitude: the cascade that a human has in the thumbs.

use super::{Known, Seen};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

const GRAVITY: f64 = 9.81;
/// Acceleration for each m/s that the velocity is off, 1/s.
const VELOCITY_GAIN: f64 = 2.0;
/// Rate for each radian of tilt, 1/s.
const ATTITUDE_GAIN: f64 = 9.0;
/// Steepest tilt, rad.
const TILT: f64 = 1.15;
/// How fast the vertical trim learns, 1/s2.
const TRIM_GAIN: f64 = 0.8;

/// The cascade and its trim.
#[derive(Clone, Debug)]
pub struct Stabiliser {
    known: Known,
    /// Vertical acceleration added so that the height holds although hover is known roughly, m/s2.
    trim: f64,
}

/// Cosine of the tilt.
pub fn upright(seen: &Seen) -> f64 {
    attitude(seen).transform_vector(&Vector3::z()).z
}

fn attitude(seen: &Seen) -> UnitQuaternion<f64> {
    let [w, x, y, z] = seen.attitude;
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

impl Stabiliser {
    pub fn new(known: Known) -> Self {
        Self { known, trim: 0.0 }
    }

    /// The command that brings the vehicle to `velocity` (world, m/s), turning to `heading` (rad) if there is one.
    pub fn velocity(&mut self, seen: &Seen, velocity: [f64; 3], heading: Option<f64>) -> [f64; 4] {
        let off = Vector3::from(velocity) - Vector3::from(seen.velocity);
        self.trim = (self.trim + 0.01 * TRIM_GAIN * off.z).clamp(-6.0, 6.0);
        let mut pushed = off * VELOCITY_GAIN + Vector3::z() * (GRAVITY + self.trim);
        pushed.z = pushed.z.max(0.25 * GRAVITY);
        let across = pushed.xy().norm();
        let most = pushed.z * TILT.tan();
        if across > most {
            pushed.x *= most / across;
            pushed.y *= most / across;
        }
        // Along the present thrust, so that a steep turn does not climb.
        let along = attitude(seen).transform_vector(&Vector3::z()).dot(&pushed);
        let [roll, pitch, yaw] = self.turn_to(seen, pushed.normalize(), heading);
        [roll, pitch, yaw, self.thrust(along)]
    }

    /// Rate commands that bring the thrust to point along `up` (world, unit), turning to `heading` (rad) if there is one.
    pub fn turn_to(&self, seen: &Seen, up: Vector3<f64>, heading: Option<f64>) -> [f64; 3] {
        let attitude = attitude(seen);
        let wanted = attitude.inverse_transform_vector(&up);
        // Rotation from body z to the wanted direction; upside down, any way round will do.
        let axis = Vector3::z().cross(&wanted);
        let angle = axis.norm().atan2(wanted.z);
        let turn = if axis.norm() > 1e-6 { axis.normalize() * angle } else { Vector3::x() * angle };
        let nose = attitude.transform_vector(&Vector3::x());
        let yaw = heading.map_or(0.0, |heading| {
            let off = heading - nose.y.atan2(nose.x);
            off.sin().atan2(off.cos())
        });
        let rates = [turn.x * ATTITUDE_GAIN, turn.y * ATTITUDE_GAIN, 3.0 * yaw];
        std::array::from_fn(|k| (rates[k] / self.known.max_rate_rad_s[k]).clamp(-1.0, 1.0))
    }

    /// The thrust command for a specific force, m/s2, by a line through hover and full thrust.
    fn thrust(&self, force: f64) -> f64 {
        let Known { hover, thrust_to_weight, .. } = self.known;
        let slope = (1.0 - hover) / (GRAVITY * (thrust_to_weight - 1.0));
        let command = hover + slope * (force - GRAVITY);
        command.clamp(-1.0, 1.0)
    }
}
