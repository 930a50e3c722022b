//! Motors: their speeds follow the controller; thrust goes with the square.

use super::airframe::Airframe;
use super::controller::MIX;
use super::faults::Faults;
use nalgebra::{Vector3, Vector4};

/// Speed (share of full) that a motor settles at for a command of 0..1 at `volts`.
pub fn speed(airframe: &Airframe, command: f64, volts: f64) -> f64 {
    (airframe.idle + (1.0 - airframe.idle) * command) * volts / airframe.full_v
}

/// Speeds after `dt` seconds of these thrust shares at `volts`.
pub fn turned(
    airframe: &Airframe,
    faults: &Faults,
    now: &Vector4<f64>,
    shares: &Vector4<f64>,
    volts: f64,
    dt: f64,
) -> Vector4<f64> {
    Vector4::from_fn(|i, _| {
        let target = shares[i].sqrt() * volts / airframe.full_v;
        let braking = if target < now[i] && faults.has("motor_braking") { faults.of("motor_braking") } else { 1.0 };
        let step = (target - now[i]) * (1.0 - (-dt / (airframe.motor_s * braking)).exp());
        let most = if faults.has("esc_slew") { faults.of("esc_slew") * dt } else { 1.0 };
        now[i] + step.clamp(-most, most)
    })
}

/// Thrust of each motor as a share of a quarter of the full thrust.
pub fn thrusts(faults: &Faults, speeds: &Vector4<f64>) -> Vector4<f64> {
    Vector4::from_fn(|i, _| {
        let lost = if i == faults.which { faults.of("tired_motor") } else { 0.0 };
        speeds[i].powi(2) * (1.0 - lost)
    })
}

/// Angular acceleration of these speeds and of their change per second, rad/s2.
pub fn turning(airframe: &Airframe, faults: &Faults, speeds: &Vector4<f64>, change: &Vector4<f64>) -> Vector3<f64> {
    let thrusts = thrusts(faults, speeds);
    let left = if faults.has("low_authority") { faults.of("low_authority") } else { 1.0 };
    let yaw = if faults.has("weak_yaw") { faults.of("weak_yaw") } else { 1.0 };
    let load = 1.0 / (1.0 + faults.of("payload"));
    Vector3::from_fn(|k, _| {
        let whole = left * load * airframe.authority[k] * if k == 2 { yaw } else { 1.0 };
        let turned = |i: usize| {
            let led = if k == 2 { airframe.rotor_lead_s * 2.0 * speeds[i] * change[i] } else { 0.0 };
            MIX[i][k] * (thrusts[i] + led)
        };
        whole * 0.25 * (0..4).map(turned).sum::<f64>()
    })
}
