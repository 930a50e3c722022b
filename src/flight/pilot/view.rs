//! What the pilot sees, in the terms it flies by.

use super::Seen;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// A moment of the flight. Position is relative to where the pilot was first asked.
#[derive(Clone, Copy, Debug)]
pub struct View {
    pub time: f64,
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub attitude: UnitQuaternion<f64>,
    pub rates: Vector3<f64>,
    pub voltage: f64,
}

impl View {
    pub fn new(seen: &Seen, origin: Vector3<f64>) -> Self {
        let [w, x, y, z] = seen.attitude;
        View {
            time: seen.time_s,
            position: Vector3::from(seen.position) - origin,
            velocity: Vector3::from(seen.velocity),
            attitude: UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)),
            rates: Vector3::from(seen.rates),
            voltage: seen.voltage,
        }
    }

    /// The body's z axis in the world.
    pub fn up(&self) -> Vector3<f64> {
        self.attitude * Vector3::z()
    }

    /// The world's z axis in the body.
    pub fn vertical(&self) -> Vector3<f64> {
        self.attitude.inverse() * Vector3::z()
    }

    /// Angle between body z and world z, rad.
    pub fn tilt(&self) -> f64 {
        self.up().z.clamp(-1.0, 1.0).acos()
    }

    /// Direction of the nose over ground, rad.
    pub fn heading(&self) -> f64 {
        let nose = self.attitude * Vector3::x();
        nose.y.atan2(nose.x)
    }
}

/// `angle` within [-pi, pi).
pub fn wrapped(angle: f64) -> f64 {
    (angle + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI
}
