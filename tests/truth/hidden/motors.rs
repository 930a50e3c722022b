//! Four motors of first order under a rate controller with filtered measurements, as flight controllers have them.

use super::link::Link;
use super::{Craft, World, inner};
use crate::truth::effects::terms::Motors;
use nalgebra::{Vector3, Vector4};
use std::f64::consts::TAU;

/// Corner of the low-pass on the gyro and of the one on its derivative, Hz.
const GYRO_HZ: f64 = 120.0;
const DERIVATIVE_HZ: f64 = 80.0;
/// Gain of the integral, 1/s, and its limit, rad/s.
const INTEGRAL: f64 = 1.5;
const WINDUP: f64 = 0.5;
/// Largest difference that the controller asks of the motors, share of full.
const MOST: f64 = 0.5;
/// What each motor does for roll, pitch and yaw; all lift.
const MIXER: [[f64; 3]; 4] = [[1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, -1.0]];
/// Share of the authority that drag torque leaves for yaw, and of the gain.
const YAW: [f64; 2] = [0.4, 0.6];

/// What the controller remembers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Controller {
    gyro: Vector3<f64>,
    slope: Vector3<f64>,
    integral: Vector3<f64>,
}

impl Controller {
    /// Commands to the motors for the next `dt` seconds, 0..1; none of them where motors are not modelled.
    pub fn next(&mut self, craft: &Craft, world: &World, link: &Link, time: f64, dt: f64) -> Vector4<f64> {
        let Some(motors) = world.terms.motors else { return Vector4::zeros() };
        let command = link.at(time);
        let lift = 0.5 * (1.0 + command[3]);
        if craft.resting {
            *self = Self::default();
            return Vector4::repeat(lift);
        }
        let smooth = |hz: f64| dt / (dt + 1.0 / (TAU * hz));
        let before = self.gyro;
        self.gyro += (craft.rates - self.gyro) * smooth(GYRO_HZ);
        self.slope += ((self.gyro - before) / dt - self.slope) * smooth(DERIVATIVE_HZ);
        let error = inner::wanted(craft, world, command) - self.gyro;
        self.integral = (self.integral + error * (INTEGRAL * dt)).map(|x| x.clamp(-WINDUP, WINDUP));
        let ask = Vector3::from_fn(|k, _| {
            let gain = motors.stiffness * if k == 2 { YAW[1] } else { 1.0 };
            let angular = gain * (error[k] + self.integral[k] - motors.damping * self.slope[k]);
            (angular / authority(&motors, k)).clamp(-MOST, MOST)
        });
        Vector4::from_fn(|m, _| (lift + Vector3::from(MIXER[m]).dot(&ask)).clamp(0.0, 1.0))
    }
}

/// Angular acceleration at full difference about `axis`, rad/s2.
fn authority(motors: &Motors, axis: usize) -> f64 {
    motors.authority * if axis == 2 { YAW[0] } else { 1.0 }
}

/// Angular acceleration that the motors' outputs cause, rad/s2.
pub fn angular(craft: &Craft, motors: &Motors) -> Vector3<f64> {
    if craft.resting {
        return Vector3::zeros();
    }
    let about = |k: usize| (0..4).map(|m| MIXER[m][k] * craft.motors[m]).sum::<f64>() / 4.0;
    Vector3::from_fn(|k, _| authority(motors, k) * about(k))
}
