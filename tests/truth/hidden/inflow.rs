//! Momentum theory: how the flow through the disk changes thrust.

use super::thrust::INDUCED;
use nalgebra::Vector3;

/// Glauert's induced velocity, m/s: v = v_h^2 / sqrt(v_xy^2 + (v_z + v)^2), with v_h that of hover at the same thrust.
///
/// The root that a hovering rotor has; in descent it goes on steadily instead of into the vortex ring.
pub fn induced(hover: f64, air: &Vector3<f64>) -> f64 {
    let across = air.xy().norm_squared();
    let (mut low, mut high) = (0.0, hover + air.z.abs() + 1.0);
    for _ in 0..40 {
        let v = 0.5 * (low + high);
        let through = (air.z + v).max(0.0);
        // Left side grows with v, from below.
        if v * (across + through * through).sqrt() < hover * hover { low = v } else { high = v }
    }
    0.5 * (low + high)
}

/// Thrust over mass (m/s2) in the flow `air`, body frame, of a rotor that gives `standing` at rest.
///
/// Blade elements lose lift with the flow through the disk over the tip speed, which is proportional to the root of the
/// standing thrust.
pub fn thrust(standing: f64, air: &Vector3<f64>, slope: f64) -> f64 {
    if standing <= 0.1 {
        return standing;
    }
    let tip = standing.sqrt();
    let hover = INDUCED * tip;
    let through = air.z + induced(hover, air);
    (standing * (1.0 - slope * (through - hover) / tip)).max(0.0)
}
