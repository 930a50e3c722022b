//! Sensors of a racing quadrotor: gyro and accelerometer at 500 Hz, odometry at 200 Hz, battery at 20 Hz.

use super::motion::Body;
use super::vehicle::Vehicle;
use super::{STEP_S, wxyz};
use nalgebra::{UnitQuaternion, Vector3};
use racer::flight::Log;
use rand::rngs::StdRng;
use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};

pub struct Sensors {
    /// Times the usual noise.
    noise: f64,
    rng: StdRng,
    gyro_bias: Vector3<f64>,
    accelerometer_bias: Vector3<f64>,
}

fn normal(rng: &mut impl Rng) -> f64 {
    StandardNormal.sample(rng)
}

fn vector(rng: &mut impl Rng, sd: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| sd * normal(rng))
}

/// A signed 16-bit count over a range.
fn quantised(x: Vector3<f64>, range: f64) -> Vector3<f64> {
    let count = range / 32768.0;
    x.map(|x| (x / count).round().clamp(-32768.0, 32767.0) * count)
}

impl Sensors {
    pub fn new(noise: f64, mut rng: StdRng) -> Self {
        let gyro_bias = vector(&mut rng, 0.01 * noise);
        let accelerometer_bias = vector(&mut rng, 0.06 * noise);
        Self { noise, rng, gyro_bias, accelerometer_bias }
    }

    /// Adds to the log what is due at integration step `step`.
    pub fn sense(&mut self, vehicle: &Vehicle, body: &Body, step: usize, log: &mut Log) {
        let time_s = step as f64 * STEP_S;
        let (noise, rng) = (self.noise, &mut self.rng);
        if step % 4 == 1 {
            let gyro = body.rates(vehicle) + self.gyro_bias + vector(rng, 0.03 * noise);
            // Vibration grows with the throttle.
            let shaken = 0.15 + 0.2 * (body.response[3] + 1.0);
            let force = body.specific_force(vehicle) + self.accelerometer_bias + vector(rng, shaken * noise);
            let (gyro, force) = (quantised(gyro, 2000f64.to_radians()), quantised(force, 16.0 * 9.80665));
            log.imu.push(time_s, [gyro.x, gyro.y, gyro.z, force.x, force.y, force.z]);
        }
        if step % 10 == 3 {
            let position = body.position + vector(rng, 0.01 * noise);
            let attitude = body.attitude * UnitQuaternion::from_scaled_axis(vector(rng, 0.003 * noise));
            let velocity = body.attitude.inverse_transform_vector(&body.velocity) + vector(rng, 0.03 * noise);
            let [w, x, y, z] = wxyz(&attitude);
            let [p, v] = [position, velocity];
            log.odometry.push(time_s, [p.x, p.y, p.z, w, x, y, z, v.x, v.y, v.z]);
        }
        if step % 100 == 7 {
            let volts = body.volts + noise * 0.02 * normal(rng);
            log.battery.push(time_s, [(volts * 100.0).round() / 100.0, f64::NAN]);
        }
        let _: f64 = rng.random();
    }
}
