//! Truths that the catalogue has no name for: the right answer is that something unexplained is there.

use super::{Hidden, log_range};
use rand::RngExt;
use rand::rngs::StdRng;

/// Names of all kinds.
pub const KINDS: [&str; 8] =
    ["throttle_play", "yaw_play", "slung_mass", "thrust_step", "drag_step", "fan", "magnus", "resonance"];

/// A kind at a random size, in a flight of `seconds`.
///
/// # Panics
///
/// Where there is no such kind.
pub fn draw(kind: &str, seconds: f64, rng: &mut StdRng) -> Hidden {
    let then = seconds * rng.random_range(0.35..0.65);
    let sign = if rng.random_bool(0.5) { -1.0 } else { 1.0 };
    let mut with = |low: f64, high: f64, more: &[(&'static str, f64)]| {
        let size = log_range(rng, low, high);
        Hidden::beyond(kind, size, &[], &[&[("size", size)], more].concat())
    };
    match kind {
        // Half the width of the backlash between stick and motor, in commands from -1 to 1.
        "throttle_play" => with(0.06, 0.15, &[]),
        "yaw_play" => with(0.1, 0.25, &[]),
        // Share of the mass that swings below, and how it swings.
        "slung_mass" => with(0.08, 0.2, &[("frequency", 1.3), ("damping", 0.08)]),
        // Share of thrust lost from one moment on, and side drag (1/s) that begins then.
        "thrust_step" => with(0.06, 0.15, &[("then", then)]),
        "drag_step" => with(0.25, 0.8, &[("then", then)]),
        // Speed of the air at its centre, m/s.
        "fan" => with(5.0, 10.0, &[("x", 12.0 * sign), ("y", 8.0)]),
        // Side force by turning and forward flight, without unit.
        "magnus" => with(0.06, 0.2, &[("sign", sign)]),
        // Side force (m/s2) of a frame that rings with the throttle.
        "resonance" => with(1.0, 2.5, &[("frequency", 4.0), ("damping", 0.05)]),
        _ => panic!("no truth outside the library `{kind}`"),
    }
}

/// Any kind.
pub fn any(seconds: f64, rng: &mut StdRng) -> Hidden {
    draw(KINDS[rng.random_range(0..KINDS.len())], seconds, rng)
}
