//! From the size of a catalogue's effect to all its parameters.

use super::catalogue::Entry;
use super::{Value, Vehicle, log_range};
use nalgebra::Vector3;
use rand::RngExt;
use rand::rngs::StdRng;
use rand_distr::StandardNormal;
use std::f64::consts::TAU;

type Parts = (Vec<Value>, Vec<(&'static str, f64)>);

/// Roll, pitch, yaw that each of four motors turns toward when it is weak.
const WEAK: [[f64; 3]; 4] = [[1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, -1.0]];

/// Parameters to be found, and the rest that the effect needs.
pub fn of(entry: &Entry, size: f64, vehicle: &Vehicle, rng: &mut StdRng) -> Parts {
    let one = |name, value: f64, unit| Value { name, value, unit, against: value.abs() };
    let main = one(entry.main, size, entry.unit);
    let known = |values: Vec<Value>| (values, Vec::new());
    match entry.id {
        "rate_second_order" | "yaw_second_order" => known(vec![main, one("zeta", rng.random_range(0.5..0.9), "")]),
        "rate_cross_coupling" => {
            let mut either = || if rng.random_bool(0.5) { size } else { -size };
            known(vec![one("kxy", either(), ""), one("kyx", either(), "")])
        }
        "thrust_asymmetric_lag" => {
            let (tau, root) = (vehicle.tau[3], size.sqrt());
            known(vec![one("tau_up", tau / root, "s"), one("tau_down", tau * root, "s")])
        }
        "voltage_relaxation" => known(vec![main, one("tau", log_range(rng, 1.0, 30.0), "s")]),
        "gusts" => known(vec![main, one("tau", log_range(rng, 0.1, 3.0), "s")]),
        "steady_wind" => {
            let (north, east) = rng.random_range(0.0..TAU).sin_cos();
            let part = |name, share: f64| Value { name, value: size * share, unit: "m/s", against: size.abs() };
            known(vec![part("wx", east), part("wy", north)])
        }
        "imu_lever_arm" | "imu_misalignment" | "accel_misalignment" => {
            known(vector(["rx", "ry", "rz"], entry, size, rng))
        }
        "accel_bias" | "gyro_bias" => known(vector(["x", "y", "z"], entry, size, rng)),
        "weak_motor" => {
            let [x, y, z] = WEAK[rng.random_range(0..4)];
            (vec![main], vec![("sx", x), ("sy", y), ("sz", z)])
        }
        _ => known(vec![main]),
    }
}

/// A vector of length `size` in any direction.
fn vector(names: [&'static str; 3], entry: &Entry, size: f64, rng: &mut StdRng) -> Vec<Value> {
    let any = Vector3::from_fn(|_, _| rng.sample::<f64, _>(StandardNormal)).normalize() * size;
    let part = |k: usize| Value { name: names[k], value: any[k], unit: entry.unit, against: size.abs() };
    (0..3).map(part).collect()
}
