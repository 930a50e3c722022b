//! What can be hidden: each cause in forms of its own, with the names of the catalogue that are right for it.

use crate::truth::effects::{Hidden, log_range};
use rand::RngExt;
use rand::rngs::StdRng;

/// A cause in one form: its name here, right names, and the range of its sizes.
pub struct Kind {
    pub id: &'static str,
    pub right: &'static [&'static str],
    pub range: [f64; 2],
}

const fn kind(id: &'static str, right: &'static [&'static str], low: f64, high: f64) -> Kind {
    Kind { id, right, range: [low, high] }
}

/// What is true of every vehicle of this truth, and in no compact model: a rate loop with filters, whose gain falls
/// with the square of the voltage, yaw led by the rotors, motors that end at full and at idle, and a mixer that makes
/// room for turns. Neither right nor wrong.
pub const OWN: [&str; 9] = [
    "rate_delay",
    "yaw_delay",
    "rate_second_order",
    "yaw_second_order",
    "rate_slew_limit",
    "yaw_slew_limit",
    "mixer_thrust_loss",
    "mixer_room",
    "response_voltage",
];

/// All forms. Units are those of the equations that use them.
pub const KINDS: &[Kind] = &[
    // Drag, with the root of the thrust, and without any throttle in it, 1/s.
    kind("drag_root", &["rotor_drag"], 0.1, 0.5),
    kind("drag_linear", &["rotor_drag"], 0.1, 0.5),
    // Thrust lost in climbs: with the root of the thrust, 1/s; by momentum theory, share of the induced velocity.
    kind("inflow_root", &["axial_inflow"], 0.3, 1.2),
    kind("inflow_momentum", &["axial_inflow", "translational_lift"], 0.25, 0.7),
    // Vertical drag in climbs alone, with another power of the speed (m^-1/2 s^-1/2), and one that saturates (1/s).
    kind("climb_power", &["vertical_drag"], 0.045, 0.13),
    kind("soft_drag", &["vertical_drag"], 0.1, 0.4),
    // Forwards only: with the square (1/m), and with the speed alone (1/s).
    kind("nose_drag", &["drag_asymmetry"], 0.004, 0.015),
    kind("nose_linear", &["drag_asymmetry"], 0.04, 0.15),
    // Drag of each axis by itself, as a share: of the flat plane and the vertical alone, and the faster the more.
    kind("axis_round", &["axis_drag"], 0.4, 1.0),
    kind("axis_fast", &["axis_drag"], 0.6, 1.4),
    // Lift (1/m, m^-1/2): of a fuselage along x alone, of a nose forwards alone, and with a lower power of the speed.
    kind("plate_lift", &["body_lift"], 0.006, 0.03),
    kind("nose_lift", &["translational_lift"], 0.006, 0.03),
    kind("advance_lift", &["translational_lift"], 0.02, 0.1),
    // Cheeseman and Bennett with the radius of the whole vehicle, m; exponential, share.
    kind("ground_cheeseman", &["ground_effect"], 0.25, 0.5),
    kind("ground_exponential", &["ground_effect"], 0.1, 0.3),
    kind("vortex_ring", &["propwash"], 0.1, 0.3),
    // Time constants down over up; change of a motor's command, 1/s.
    kind("motor_braking", &["thrust_asymmetric_lag"], 1.6, 2.5),
    kind("esc_slew", &["thrust_asymmetric_lag", "thrust_delay", "rate_slew_limit"], 3.0, 8.0),
    // Filters and delays on the way, s.
    kind("throttle_filter", &["thrust_delay"], 0.006, 0.02),
    kind("throttle_link", &["thrust_delay"], 0.008, 0.025),
    kind("link_jitter", &["link_delay", "rate_delay", "thrust_delay", "command_dropout"], 0.008, 0.03),
    kind("stick_filter", &["rate_delay", "rate_second_order"], 0.004, 0.012),
    // Curves of the sticks.
    kind("super_rate", &["rate_expo"], 0.25, 0.6),
    kind("power_rate", &["rate_expo"], 1.2, 1.6),
    // Shares of the usual authority that are left.
    kind("low_authority", &["rate_slew_limit", "rate_second_order", "mixer_thrust_loss"], 0.25, 0.4),
    kind("weak_yaw", &["yaw_slew_limit", "rate_slew_limit", "yaw_authority_loss", "yaw_delay"], 0.15, 0.35),
    // The pack: volts at full load, by thrust^1.5 and by electric power; what comes back; the curve; shares.
    kind("load_power", &["voltage_sag", "voltage_relaxation"], 0.8, 2.5),
    kind("load_electric", &["voltage_sag", "voltage_relaxation"], 0.8, 2.5),
    kind("slow_cells", &["voltage_relaxation", "voltage_sag"], 0.5, 1.5),
    kind("ocv_bent", &["ocv_curve"], 0.3, 0.8),
    kind("ocv_knee", &["ocv_curve"], 0.3, 0.8),
    kind("esc_voltage", &["voltage_compensation"], 0.5, 1.0),
    kind("hot_magnets", &["thrust_fade"], 0.05, 0.12),
    kind("worn_pack", &["thrust_fade"], 0.05, 0.12),
    kind("payload", &["mass_or_density"], 0.1, 0.3),
    kind("thin_air", &["mass_or_density"], 0.1, 0.2),
    // Air that moves, m/s.
    kind("wind_shear", &["steady_wind"], 1.5, 4.0),
    kind("wind_veer", &["steady_wind"], 1.5, 4.0),
    kind("stirred_air", &["gusts", "steady_wind"], 1.0, 3.0),
    // Sensors: times in s, angles in rad, lengths in m, shares, m/s2, rad/s.
    kind("imu_late", &["stream_offset", "imu_late"], 0.004, 0.012),
    kind("gyro_filter", &["stream_offset"], 0.002, 0.006),
    kind("accel_tilt", &["accel_misalignment", "imu_misalignment"], 0.015, 0.05),
    kind("imu_tilt", &["imu_misalignment"], 0.015, 0.05),
    kind("lever_soft", &["imu_lever_arm"], 0.015, 0.05),
    kind("accel_warm", &["accel_bias"], 0.15, 0.4),
    kind("accel_axis", &["accel_scale", "accel_bias"], 0.02, 0.05),
    kind("gyro_warm", &["gyro_bias"], 0.015, 0.04),
    kind("gyro_axis", &["gyro_scale"], 0.02, 0.05),
    kind("vibration_speed", &["vibration_rectification"], 0.3, 0.8),
    kind("vibration_bell", &["vibration_rectification"], 0.4, 1.0),
    kind("velocity_delay", &["velocity_lag"], 0.03, 0.09),
    kind("velocity_observer", &["velocity_lag"], 0.03, 0.09),
    kind("clock_bend", &["clock_skew"], 1e-4, 1e-3),
    // Share of a motor's thrust that is lost, behind the controller's integrator.
    kind("tired_motor", &["weak_motor"], 0.08, 0.2),
];

/// Forms that were here until the catalogue had them: a plate above in climbs alone, a nose in the whole flow (1/m).
pub const KNOWN: &[Kind] =
    &[kind("climb_drag", &["vertical_drag"], 0.02, 0.06), kind("nose_speed", &["drag_asymmetry"], 0.004, 0.015)];

/// What the catalogue has no name for: thrust that breaks (share), a frame that rings with the throttle (m/s2), a fan
/// (m/s).
pub const OUTSIDE: &[Kind] =
    &[kind("thrust_break", &[], 0.06, 0.15), kind("ringing_frame", &[], 1.0, 2.5), kind("fan_corner", &[], 4.0, 8.0)];

/// The cause `id` at a random size, times `scale`.
///
/// # Panics
///
/// Where there is no such cause.
pub fn draw(id: &str, scale: f64, rng: &mut StdRng) -> Hidden {
    let all = || KINDS.iter().chain(OUTSIDE).chain(KNOWN);
    let kind = all().find(|kind| kind.id == id).unwrap_or_else(|| panic!("no cause `{id}`"));
    let size = scale * log_range(rng, kind.range[0], kind.range[1]);
    Hidden::beyond(id, size, kind.right, &[])
}

/// Any cause of the catalogue.
pub fn any(rng: &mut StdRng) -> &'static Kind {
    &KINDS[rng.random_range(0..KINDS.len())]
}

/// Two causes without a right name in common.
pub fn pair(rng: &mut StdRng) -> [&'static Kind; 2] {
    loop {
        let [a, b] = [any(rng), any(rng)];
        if a.right.iter().all(|name| !b.right.contains(name)) {
            return [a, b];
        }
    }
}

/// A cause that changes in proportion to its size.
pub fn small(rng: &mut StdRng) -> &'static Kind {
    const OTHER_SCALE: [&str; 6] =
        ["motor_braking", "esc_slew", "power_rate", "low_authority", "weak_yaw", "ground_cheeseman"];
    loop {
        let one = any(rng);
        if !OTHER_SCALE.contains(&one.id) {
            return one;
        }
    }
}
