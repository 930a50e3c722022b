//! The state of the simulated vehicle.

use super::vehicle::Vehicle;
use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};

/// World ENU, body front-left-up, attitude body to world.
#[derive(Clone, Copy, Debug)]
pub struct State {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub attitude: Quaternion<f64>,
    /// Responses to the four commands, -1..1.
    pub response: Vector4<f64>,
    pub voltage: f64,
    /// Whether the ground carries it.
    pub resting: bool,
}

impl State {
    /// At rest with a full battery.
    pub fn on_ground(vehicle: &Vehicle) -> Self {
        State {
            position: Vector3::zeros(),
            velocity: Vector3::zeros(),
            attitude: Quaternion::identity(),
            response: Vector4::new(0.0, 0.0, 0.0, -1.0),
            voltage: vehicle.full_v,
            resting: true,
        }
    }

    pub fn rotation(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::from_quaternion(self.attitude)
    }

    /// Body rates, rad/s.
    pub fn rates(&self, vehicle: &Vehicle) -> Vector3<f64> {
        if self.resting {
            return Vector3::zeros();
        }
        Vector3::from(vehicle.max_rate).component_mul(&self.response.xyz())
    }

    /// Velocity in the body frame, m/s.
    pub fn body_velocity(&self) -> Vector3<f64> {
        self.rotation().inverse() * self.velocity
    }
}
