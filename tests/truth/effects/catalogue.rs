//! The identifiers of the catalogue and their typical sizes.

use super::Vehicle;
use rand::RngExt;
use rand::rngs::StdRng;

/// An effect of the catalogue by its main parameter.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub id: &'static str,
    /// Name of the main parameter, and its unit; of a vector its length.
    pub main: &'static str,
    pub unit: &'static str,
    /// Typical size; volts are those of a 6S pack.
    pub low: f64,
    pub high: f64,
    /// Whether it may be negative.
    pub signed: bool,
}

const fn entry_of(
    id: &'static str,
    main: &'static str,
    unit: &'static str,
    low: f64,
    high: f64,
    signed: bool,
) -> Entry {
    Entry { id, main, unit, low, high, signed }
}

const DEG: f64 = std::f64::consts::PI / 180.0;

pub const CATALOGUE: &[Entry] = &[
    entry_of("rate_delay", "delay", "s", 0.002, 0.05, false),
    entry_of("yaw_delay", "extra", "s", 0.004, 0.03, false),
    entry_of("thrust_delay", "delay", "s", 0.002, 0.03, false),
    entry_of("rate_second_order", "wn", "rad/s", 60.0, 150.0, false),
    entry_of("yaw_second_order", "wn", "rad/s", 15.0, 60.0, false),
    entry_of("rate_slew_limit", "limit", "rad/s2", 100.0, 600.0, false),
    entry_of("yaw_slew_limit", "limit", "rad/s2", 10.0, 60.0, false),
    entry_of("rate_expo", "e", "", 0.05, 0.5, false),
    entry_of("response_voltage", "k", "1/V", 0.05, 0.2, false),
    entry_of("stream_offset", "offset", "s", 0.001, 0.015, false),
    entry_of("clock_skew", "skew", "", 1e-4, 1.6e-2, true),
    entry_of("command_dropout", "probability", "", 0.02, 0.2, false),
    entry_of("rate_cross_coupling", "k", "", 0.01, 0.1, false),
    entry_of("gyroscopic_coupling", "k", "", 0.01, 0.05, true),
    entry_of("yaw_authority_loss", "k", "", 0.1, 0.6, false),
    entry_of("weak_motor", "b", "rad/s", 0.05, 0.6, false),
    entry_of("thrust_asymmetric_lag", "ratio", "", 1.5, 2.5, false),
    entry_of("voltage_sag", "v_full", "V", 1.2, 4.0, false),
    entry_of("voltage_relaxation", "v_full", "V", 0.5, 2.0, false),
    entry_of("ocv_curve", "k", "V", 0.2, 0.8, false),
    entry_of("voltage_compensation", "share", "", 0.2, 1.0, false),
    entry_of("throttle_offset", "u0", "", 0.01, 0.05, true),
    entry_of("axial_inflow", "k", "1/s", 0.2, 1.7, false),
    entry_of("translational_lift", "k", "1/m", 0.003, 0.03, false),
    entry_of("propwash", "k", "", 0.08, 0.33, false),
    entry_of("ground_effect", "k", "", 1.0, 12.0, false),
    entry_of("mixer_room", "k", "s/rad", 0.02, 0.1, false),
    entry_of("mixer_thrust_loss", "k", "", 0.02, 0.1, false),
    entry_of("rate_thrust_coupling", "k", "m/s2 per (rad/s)2", 0.002, 0.02, false),
    entry_of("thrust_fade", "k", "", 0.02, 0.08, false),
    entry_of("mass_or_density", "share", "", 0.05, 0.3, true),
    entry_of("axis_drag", "share", "", 0.3, 1.0, false),
    entry_of("rotor_drag", "k", "1/s", 0.05, 0.5, false),
    entry_of("drag_asymmetry", "k", "1/m", 0.001, 0.008, true),
    entry_of("body_lift", "k", "1/m", 0.003, 0.03, false),
    entry_of("vertical_drag", "k", "1/s", 0.05, 0.3, false),
    entry_of("steady_wind", "speed", "m/s", 0.5, 4.0, false),
    entry_of("gusts", "sigma", "m/s2", 0.2, 1.0, false),
    entry_of("imu_lever_arm", "length", "m", 0.005, 0.03, false),
    entry_of("imu_misalignment", "angle", "rad", 0.3 * DEG, 4.0 * DEG, false),
    entry_of("accel_misalignment", "angle", "rad", 0.6 * DEG, 3.0 * DEG, false),
    entry_of("accel_bias", "length", "m/s2", 0.05, 0.4, false),
    entry_of("accel_scale", "scale", "", 0.005, 0.03, true),
    entry_of("gyro_bias", "length", "rad/s", 0.006, 0.02, false),
    entry_of("gyro_scale", "scale", "", 0.005, 0.03, true),
    entry_of("velocity_lag", "tau", "s", 0.01, 0.08, false),
    entry_of("vibration_rectification", "k", "m/s2", 0.05, 0.5, true),
];

/// The entry of that identifier.
///
/// # Panics
///
/// Where there is none.
pub fn entry(id: &str) -> &'static Entry {
    CATALOGUE.iter().find(|entry| entry.id == id).unwrap_or_else(|| panic!("no effect `{id}` in the catalogue"))
}

/// What replaces the law of the rates' response, the more of it the smaller its number.
const REPLACING: [&str; 4] = ["rate_second_order", "yaw_second_order", "rate_slew_limit", "yaw_slew_limit"];

/// Any identifier.
pub fn any(rng: &mut StdRng) -> &'static str {
    CATALOGUE[rng.random_range(0..CATALOGUE.len())].id
}

/// Two identifiers that can act together.
pub fn pair(rng: &mut StdRng) -> [&'static str; 2] {
    loop {
        let [a, b] = [any(rng), any(rng)];
        // Each of these replaces the same law.
        let rival = |id| REPLACING.contains(&id);
        if a != b && !(rival(a) && rival(b)) {
            return [a, b];
        }
    }
}

impl Entry {
    /// Typical sizes for `vehicle`.
    pub fn range(&self, vehicle: &Vehicle) -> [f64; 2] {
        let pack = if self.unit == "V" { vehicle.full_v / 25.0 } else { 1.0 };
        [self.low * pack, self.high * pack]
    }

    /// Whether a smaller size is more of it.
    pub fn grows_downwards(&self) -> bool {
        REPLACING.contains(&self.id)
    }

    /// Whether it changes how the vehicle flies, and in ordinary flight.
    pub fn dominates(&self) -> bool {
        let only_measured = self.id.starts_with("imu_")
            || self.id.starts_with("accel_")
            || self.id.starts_with("gyro_")
            || matches!(self.id, "stream_offset" | "clock_skew" | "velocity_lag" | "vibration_rectification");
        let rarely_felt =
            matches!(self.id, "ground_effect" | "gyroscopic_coupling" | "yaw_authority_loss" | "ocv_curve");
        !only_measured && !rarely_felt
    }

    /// Whether it vanishes with its size.
    pub fn shrinks(&self) -> bool {
        !self.grows_downwards() && self.id != "thrust_asymmetric_lag"
    }
}
