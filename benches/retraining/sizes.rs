//! Sizes at which racing feels an effect: typical ones, from the large end of the catalogue.

use crate::truth::effects::catalogue::CATALOGUE;

/// Identifier and main parameter, in the catalogue's unit; volts are those of the seed class's pack.
pub const SIZES: [(&str, f64); 23] = [
    ("rate_delay", 0.03),
    ("thrust_delay", 0.03),
    ("rate_second_order", 60.0),
    ("rate_slew_limit", 120.0),
    ("rate_expo", 0.4),
    ("response_voltage", 0.2),
    ("rate_cross_coupling", 0.1),
    ("yaw_authority_loss", 0.6),
    ("weak_motor", 0.5),
    ("thrust_asymmetric_lag", 2.5),
    ("voltage_sag", 2.5),
    ("voltage_relaxation", 2.0),
    ("throttle_offset", -0.05),
    ("axial_inflow", 0.8),
    ("translational_lift", 0.02),
    ("propwash", 0.3),
    ("mixer_thrust_loss", 0.1),
    ("rate_thrust_coupling", 0.02),
    ("mass_or_density", -0.25),
    ("rotor_drag", 0.3),
    ("body_lift", 0.02),
    ("vertical_drag", 0.3),
    ("steady_wind", 4.0),
];

pub fn of(id: &str) -> Option<f64> {
    SIZES.iter().find(|(known, _)| *known == id).map(|(_, size)| *size)
}

pub fn known(id: &str) -> bool {
    CATALOGUE.iter().any(|entry| entry.id == id)
}
