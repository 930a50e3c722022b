//! Forces of the air, and the air's own motion.

use super::airframe::{Airframe, GRAVITY};
use super::faults::Faults;
use nalgebra::{UnitQuaternion, Vector3};

/// Where it is, how it moves, and what its motors push.
pub struct Motion {
    pub position: Vector3<f64>,
    /// Of the body through the world, m/s.
    pub velocity: Vector3<f64>,
    pub attitude: UnitQuaternion<f64>,
    /// Thrust of all motors in still air, N.
    pub thrust: f64,
    /// Thrust over full thrust, summed over time, s.
    pub used: f64,
    pub time: f64,
    /// Deflection of a frame that rings, m/s2.
    pub ringing: f64,
}

/// Velocity of the air in the world, m/s.
pub fn wind(faults: &Faults, position: &Vector3<f64>, time: f64) -> Vector3<f64> {
    let flat = Vector3::new(faults.along.x, faults.along.y, 0.0);
    let flat = flat.try_normalize(1e-6).unwrap_or_else(Vector3::x);
    let across = Vector3::new(-flat.y, flat.x, 0.0);
    let mut all = flat * faults.of("wind_shear") * (position.z.max(0.3) / 5.0).powf(0.25);
    let veer = 0.8 * time / faults.seconds;
    all += (flat * veer.cos() + across * veer.sin()) * faults.of("wind_veer");
    all += faults.air(time) * faults.of("stirred_air");
    let away = (position.xy() - flat.xy() * 6.0).norm();
    all + across * faults.of("fan_corner") * (-(away / 5.0).powi(2)).exp()
}

/// Thrust and drag over the mass, body frame, m/s2.
pub fn specific_force(airframe: &Airframe, faults: &Faults, m: &Motion) -> Vector3<f64> {
    let mass = airframe.mass * (1.0 + faults.of("payload"));
    let density = 1.0 - faults.of("thin_air");
    let v = m.attitude.inverse() * (m.velocity - wind(faults, &m.position, m.time));
    let thrust = density * m.thrust * lasting(faults, m) / mass;
    let mut force = Vector3::new(m.ringing, 0.0, inflow(faults, thrust, &v, m));
    force += body(airframe, faults, &v) * (density / mass);
    force + extra(faults, thrust, &v)
}

/// Share of the thrust that time leaves.
fn lasting(faults: &Faults, m: &Motion) -> f64 {
    let heat = 1.0 - (-m.time / (0.5 * faults.seconds)).exp();
    let broken = if m.time > 0.55 * faults.seconds { faults.of("thrust_break") } else { 0.0 };
    // An hour at hover would use the share up many times: by the end of the flight about once.
    let worn = faults.of("worn_pack") * (m.used / (0.25 * faults.seconds)).min(1.5);
    (1.0 - faults.of("hot_magnets") * heat - broken - worn).max(0.2)
}

/// Thrust over mass in the flow and near the ground.
fn inflow(faults: &Faults, thrust: f64, v: &Vector3<f64>, m: &Motion) -> f64 {
    let root = (thrust.max(0.0) / GRAVITY).sqrt();
    let mut out = thrust - faults.of("inflow_root") * v.z * root;
    let share = faults.of("inflow_momentum");
    if share > 0.0 && thrust > 0.1 {
        // Glauert: induced velocity where it hovers 5 m/s; thrust falls with the flow through the disk beyond that.
        let still = 5.0 * root;
        let mut induced = still;
        for _ in 0..12 {
            induced =
                0.5 * (induced + still * still / (v.xy().norm().powi(2) + (v.z + induced).powi(2)).sqrt().max(1.0));
        }
        out = thrust * (1.0 - share * (v.z + induced - still) / (8.0 + 5.0 * root));
    }
    let sink = -v.z / (5.0 * root + 0.5);
    out *= 1.0 - faults.of("vortex_ring") * (1.0 - (sink - 1.0).abs() / 0.8).max(0.0);
    let height = m.position.z.max(0.0) + 0.06;
    let radius = faults.of("ground_cheeseman");
    if radius > 0.0 {
        out /= 1.0 - (radius / (4.0 * height)).powi(2).min(0.35);
    }
    out * (1.0 + faults.of("ground_exponential") * (-height / 0.25).exp())
}

/// Drag of the body, N: along the flow, by the silhouette, as far as nothing is hidden.
fn body(airframe: &Airframe, faults: &Faults, v: &Vector3<f64>) -> Vector3<f64> {
    let k = Vector3::from(airframe.drag());
    let (speed, flat) = (v.norm(), Vector3::new(v.x, v.y, 0.0));
    let along = -v * k.component_mul(v).norm();
    let round = flat * (k.component_mul(&flat).norm() / flat.norm().max(1e-9)) + Vector3::z() * (k.z * v.z);
    let (some, much) = (faults.of("axis_round"), faults.of("axis_fast") * speed / (speed + 5.0));
    along + (-round * speed - along) * some + (-k.component_mul(v) * speed - along) * much
}

/// What is hidden in drag and lift, m/s2.
fn extra(faults: &Faults, thrust: f64, v: &Vector3<f64>) -> Vector3<f64> {
    let root = (thrust.max(0.0) / GRAVITY).sqrt();
    let flat = Vector3::new(v.x, v.y, 0.0);
    let mut force = -flat * (faults.of("drag_root") * root + faults.of("drag_linear"));
    let (forward, up) = (v.x.max(0.0), v.z.max(0.0));
    force.z -= faults.of("climb_drag") * up * up + faults.of("climb_power") * up.powf(1.5);
    force.z -= faults.of("soft_drag") * 3.0 * (v.z / 3.0).tanh();
    let nose = faults.of("nose_drag") * forward + faults.of("nose_speed") * v.norm() + faults.of("nose_linear");
    force.x -= nose * forward;
    let plate = faults.of("plate_lift");
    force.z -= plate * v.x.abs() * v.z;
    force.x += plate * v.z * v.z * v.x.signum() * v.x.abs().min(1.0);
    force.z += faults.of("nose_lift") * forward * forward + faults.of("advance_lift") * flat.norm().powf(1.5);
    force
}
