//! Runge-Kutta of fourth order over all states, and the ground.

use super::{State, Vehicle, drag, response, thrust};
use nalgebra::{Quaternion, Vector3, Vector4};

/// Force over mass without gravity, body frame, m/s2: what an accelerometer at the centre feels.
pub fn specific_force(s: &State, vehicle: &Vehicle) -> Vector3<f64> {
    if s.resting {
        return Vector3::new(0.0, 0.0, vehicle.gravity);
    }
    let lift = thrust::per_mass(vehicle, s.response.w, s.voltage);
    Vector3::new(0.0, 0.0, lift) + drag::per_mass(vehicle, &s.body_velocity())
}

struct Slope {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    attitude: Quaternion<f64>,
    response: Vector4<f64>,
    voltage: f64,
}

fn slope(s: &State, vehicle: &Vehicle, command: [f64; 4]) -> Slope {
    let rates = s.rates(vehicle);
    Slope {
        position: s.velocity,
        velocity: s.rotation() * specific_force(s, vehicle) - Vector3::new(0.0, 0.0, vehicle.gravity),
        attitude: s.attitude * Quaternion::from_imag(rates) * 0.5,
        response: response::change(&s.response, command, vehicle),
        voltage: vehicle.voltage_rate,
    }
}

fn moved(s: &State, by: &Slope, dt: f64) -> State {
    State {
        position: s.position + by.position * dt,
        velocity: s.velocity + by.velocity * dt,
        attitude: (s.attitude + by.attitude * dt).normalize(),
        response: s.response + by.response * dt,
        voltage: s.voltage + by.voltage * dt,
        resting: s.resting,
    }
}

/// The state `dt` seconds later, the command held.
pub fn step(s: &State, vehicle: &Vehicle, command: [f64; 4], dt: f64) -> State {
    let lifts = thrust::per_mass(vehicle, s.response.w, s.voltage) > vehicle.gravity;
    let start = State { resting: s.resting && !lifts, ..*s };
    let a = slope(&start, vehicle, command);
    let b = slope(&moved(&start, &a, 0.5 * dt), vehicle, command);
    let c = slope(&moved(&start, &b, 0.5 * dt), vehicle, command);
    let d = slope(&moved(&start, &c, dt), vehicle, command);
    let mean = Slope {
        position: (a.position + (b.position + c.position) * 2.0 + d.position) / 6.0,
        velocity: (a.velocity + (b.velocity + c.velocity) * 2.0 + d.velocity) / 6.0,
        attitude: (a.attitude + (b.attitude + c.attitude) * 2.0 + d.attitude) * (1.0 / 6.0),
        response: (a.response + (b.response + c.response) * 2.0 + d.response) / 6.0,
        voltage: (a.voltage + 2.0 * (b.voltage + c.voltage) + d.voltage) / 6.0,
    };
    on_ground(moved(&start, &mean, dt))
}

/// Stops what has come down to the ground; it comes to stand level, and takes off again when thrust lifts it.
fn on_ground(mut s: State) -> State {
    if s.position.z < 0.0 {
        let (_, _, yaw) = s.rotation().euler_angles();
        let half = 0.5 * yaw;
        s.position.z = 0.0;
        s.velocity = Vector3::zeros();
        s.attitude = Quaternion::new(half.cos(), 0.0, 0.0, half.sin());
        s.resting = true;
    }
    s
}
