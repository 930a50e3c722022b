//! Truths of the catalogue's causes in forms of their own, which no extension of the library has.

use super::{Hidden, Vehicle, log_range};
use rand::RngExt;
use rand::rngs::StdRng;

/// Names of all kinds.
pub const KINDS: [&str; 9] = [
    "motor_loop",
    "motor_saturation",
    "momentum_inflow",
    "blade_drag",
    "cell_circuit",
    "jittery_link",
    "turbulence",
    "hot_motors",
    "estimator",
];

/// A kind at a random size.
///
/// # Panics
///
/// Where there is no such kind.
pub fn draw(kind: &str, vehicle: &Vehicle, rng: &mut StdRng) -> Hidden {
    let pack = vehicle.full_v / 25.0;
    match kind {
        // Motors of first order under a rate controller with filters: stiffness and damping of the loop, 1/s and s, and
        // the acceleration (rad/s2) that opposite motors at full difference give.
        "motor_loop" | "motor_saturation" => {
            let stiff = rng.random_range(55.0..90.0);
            let saturates = kind == "motor_saturation";
            let authority = if saturates { log_range(rng, 250.0, 700.0) } else { 6000.0 };
            let right: &[_] = if saturates {
                &["rate_slew_limit", "rate_second_order", "mixer_thrust_loss"]
            } else {
                &["rate_second_order", "rate_delay"]
            };
            let damping = rng.random_range(0.003..0.005);
            let lag = vehicle.tau[3].clamp(0.008, 0.018);
            let secret = [("stiffness", stiff), ("damping", damping), ("lag", lag), ("authority", authority)];
            Hidden::beyond(kind, stiff, right, &secret)
        }
        // Loss of thrust with the flow through the disk, at the tip speed of hover.
        "momentum_inflow" => {
            let slope = log_range(rng, 0.06, 0.2);
            Hidden::beyond(kind, slope, &["axial_inflow", "translational_lift"], &[("slope", slope)])
        }
        "blade_drag" => {
            let size = log_range(rng, 0.1, 0.6);
            Hidden::beyond(kind, size, &["rotor_drag"], &[("k", size)])
        }
        // Resistance and one resistor-capacitor pair, load with thrust to the power of 1.5; charge is what the current
        // took.
        "cell_circuit" => {
            let [at_once, later] = [log_range(rng, 1.2, 3.0) * pack, log_range(rng, 0.5, 1.5) * pack];
            let secret = [("at_once", at_once), ("later", later), ("tau", log_range(rng, 3.0, 30.0))];
            Hidden::beyond(kind, at_once, &["voltage_sag", "voltage_relaxation"], &secret)
        }
        "jittery_link" => {
            let delay = log_range(rng, 0.008, 0.04);
            Hidden::beyond(kind, delay, &["rate_delay"], &[("delay", delay), ("jitter", 0.2 * delay)])
        }
        // Air that moves, instead of a force: the drag of what it blows at follows from it.
        "turbulence" => {
            let sigma = log_range(rng, 1.5, 4.0);
            let secret = [("sigma", sigma), ("tau", log_range(rng, 0.3, 2.0))];
            Hidden::beyond(kind, sigma, &["gusts", "steady_wind"], &secret)
        }
        "hot_motors" => {
            let loss = log_range(rng, 0.04, 0.1);
            Hidden::beyond(kind, loss, &["thrust_fade"], &[("loss", loss), ("tau", rng.random_range(60.0..150.0))])
        }
        // A second-order observer instead of a low-pass.
        "estimator" => {
            let lag = log_range(rng, 0.02, 0.08);
            Hidden::beyond(kind, lag, &["velocity_lag"], &[("lag", lag)])
        }
        _ => panic!("no unmatched truth `{kind}`"),
    }
}

/// Any kind.
pub fn any(vehicle: &Vehicle, rng: &mut StdRng) -> Hidden {
    draw(KINDS[rng.random_range(0..KINDS.len())], vehicle, rng)
}
