//! How the true vehicle moves: classic fourth-order Runge-Kutta on position, velocity, attitude, response and voltage.

use super::vehicle::{GRAVITY, Vehicle};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

#[derive(Clone, Debug)]
pub struct Body {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub attitude: UnitQuaternion<f64>,
    /// What the commands have become behind their lags.
    pub response: [f64; 4],
    pub volts: f64,
}

/// Time derivatives of a body's numbers.
struct Change {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    attitude: Quaternion<f64>,
    response: [f64; 4],
    volts: f64,
}

/// Area of the silhouette of an ellipsoid seen along `n` (unit, body frame), m2: that of the ellipse that the sphere's
/// shadow becomes when space is stretched by the semi-axes.
pub fn silhouette([a, b, c]: [f64; 3], n: Vector3<f64>) -> f64 {
    let shrunk = Vector3::new(n.x / a, n.y / b, n.z / c);
    std::f64::consts::PI * a * b * c * shrunk.norm()
}

impl Body {
    /// On the ground, level, rotors idle.
    pub fn resting(volts: f64) -> Self {
        Body {
            position: Vector3::zeros(),
            velocity: Vector3::zeros(),
            attitude: UnitQuaternion::identity(),
            response: [0.0, 0.0, 0.0, -1.0],
            volts,
        }
    }

    /// Whether the ground carries it.
    pub fn grounded(&self, vehicle: &Vehicle) -> bool {
        self.position.z <= 0.0 && vehicle.push(self.response[3], self.volts) < GRAVITY
    }

    /// Body rates, rad/s.
    pub fn rates(&self, vehicle: &Vehicle) -> Vector3<f64> {
        if self.grounded(vehicle) {
            return Vector3::zeros();
        }
        Vector3::from_fn(|k, _| self.response[k] * vehicle.max_rate[k])
    }

    /// What an ideal accelerometer feels, body frame, m/s2.
    pub fn specific_force(&self, vehicle: &Vehicle) -> Vector3<f64> {
        if self.grounded(vehicle) {
            return self.attitude.inverse_transform_vector(&Vector3::new(0.0, 0.0, GRAVITY));
        }
        let flow = self.attitude.inverse_transform_vector(&self.velocity);
        let speed = flow.norm();
        let mut drag = Vector3::zeros();
        if speed > 1e-9 {
            let area = silhouette(vehicle.semi_axes, flow / speed);
            drag = -flow * (vehicle.density * vehicle.drag_coefficient * area * speed / (2.0 * vehicle.mass));
        }
        Vector3::new(0.0, 0.0, vehicle.push(self.response[3], self.volts)) + drag
    }

    fn change(&self, vehicle: &Vehicle, command: [f64; 4]) -> Change {
        let response = std::array::from_fn(|k| (command[k] - self.response[k]) / vehicle.tau[k]);
        if self.grounded(vehicle) {
            let volts = vehicle.discharge;
            let still = Vector3::zeros();
            return Change {
                position: still,
                velocity: still,
                attitude: Quaternion::new(0.0, 0.0, 0.0, 0.0),
                response,
                volts,
            };
        }
        let rates = self.rates(vehicle);
        Change {
            position: self.velocity,
            velocity: self.attitude * self.specific_force(vehicle) - Vector3::new(0.0, 0.0, GRAVITY),
            attitude: self.attitude.quaternion() * Quaternion::from_imag(rates) * 0.5,
            response,
            volts: vehicle.discharge,
        }
    }

    fn moved(&self, by: &Change, dt: f64) -> Body {
        Body {
            position: self.position + by.position * dt,
            velocity: self.velocity + by.velocity * dt,
            attitude: UnitQuaternion::new_normalize(self.attitude.quaternion() + by.attitude * dt),
            response: std::array::from_fn(|k| self.response[k] + by.response[k] * dt),
            volts: self.volts + by.volts * dt,
        }
    }

    pub fn advance(&mut self, vehicle: &Vehicle, command: [f64; 4], dt: f64) {
        let k1 = self.change(vehicle, command);
        let k2 = self.moved(&k1, dt / 2.0).change(vehicle, command);
        let k3 = self.moved(&k2, dt / 2.0).change(vehicle, command);
        let k4 = self.moved(&k3, dt).change(vehicle, command);
        let mean = Change {
            position: (k1.position + (k2.position + k3.position) * 2.0 + k4.position) / 6.0,
            velocity: (k1.velocity + (k2.velocity + k3.velocity) * 2.0 + k4.velocity) / 6.0,
            attitude: (k1.attitude + (k2.attitude + k3.attitude) * 2.0 + k4.attitude) / 6.0,
            response: std::array::from_fn(|k| {
                (k1.response[k] + 2.0 * k2.response[k] + 2.0 * k3.response[k] + k4.response[k]) / 6.0
            }),
            volts: k1.volts,
        };
        *self = self.moved(&mean, dt);
        self.position.z = self.position.z.max(0.0);
        if self.grounded(vehicle) {
            self.velocity = Vector3::zeros();
        }
    }
}
