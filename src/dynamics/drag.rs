//! Aerodynamic drag of an ellipsoid: its projected area, and so the drag, depends on the direction of flight.

use super::attitude::dot;
use crate::lane::{Real, build};
use crate::vehicle::Drag;

/// rho C_D / 2 times pi times the product of the two other semi-axes, for flow along each body axis, kg/m.
///
/// The silhouette of an ellipsoid with semi-axes (a, b, c) along the unit vector n has the area
/// pi sqrt((b c n_x)^2 + (a c n_y)^2 + (a b n_z)^2).
pub fn ellipsoid(drag: &Drag) -> [f64; 3] {
    let [a, b, c] = drag.semi_axes_m;
    [b * c, a * c, a * b].map(|area| 0.5 * drag.air_density_kg_m3 * drag.coefficient * std::f64::consts::PI * area)
}

/// The factor k of the drag acceleration -k v, 1/s: per-axis drag `k` (1/m), body axes in the world, velocity in the
/// world. |v| times the projected area needs no division by |v|.
#[inline(always)]
pub fn damping<R: Real>(k: &[R; 3], axes: &[[R; 3]; 3], velocity: [R; 3]) -> R {
    let scaled: [R; 3] = build!(|i| k[i] * dot(axes[i], velocity));
    dot(scaled, scaled).sqrt()
}
