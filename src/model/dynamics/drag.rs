//! Aerodynamic drag of an ellipsoid: its projected area, and so the drag, depends on the direction of flight.

use crate::base::lane::{Real, build};
use crate::model::attitude::dot;
use crate::model::vehicle::Drag;

/// rho C_D / 2 times pi times the product of the two other semi-axes, for flow along each body axis, kg/m.
///
/// The silhouette of an ellipsoid with semi-axes (a, b, c) along the unit vector n has the area
/// pi sqrt((b c n_x)^2 + (a c n_y)^2 + (a b n_z)^2).
pub fn ellipsoid(drag: &Drag) -> [f64; 3] {
    let [a, b, c] = drag.semi_axes_m;
    [b * c, a * c, a * b].map(|area| 0.5 * drag.air_density_kg_m3 * drag.coefficient * std::f64::consts::PI * area)
}

/// Semi-axes (m) of the ellipsoid with this coefficient and air density (kg/m3) whose [`ellipsoid`] is `k` (kg/m, above
/// 0).
pub fn semi_axes(k: [f64; 3], coefficient: f64, air_density_kg_m3: f64) -> [f64; 3] {
    let [x, y, z] = k.map(|k| k / (0.5 * air_density_kg_m3 * coefficient * std::f64::consts::PI));
    [(y * z / x).sqrt(), (x * z / y).sqrt(), (x * y / z).sqrt()]
}

/// The factor k of the drag acceleration -k v, 1/s: per-axis drag `k` (1/m), body axes in the world, velocity in the
/// world. |v| times the projected area needs no division by |v|.
#[inline(always)]
pub fn damping<R: Real>(k: &[R; 3], axes: &[[R; 3]; 3], velocity: [R; 3]) -> R {
    damping_in_body(k, build!(|i| dot(axes[i], velocity)))
}

/// [`damping`] for a velocity in the body frame.
#[inline(always)]
pub fn damping_in_body<R: Real>(k: &[R; 3], velocity: [R; 3]) -> R {
    let scaled: [R; 3] = build!(|i| k[i] * velocity[i]);
    dot(scaled, scaled).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn semi_axes_lead_back_to_themselves() {
        let drag = Drag { semi_axes_m: [0.1, 0.12, 0.04], coefficient: 1.4, air_density_kg_m3: 1.2 };
        let found = semi_axes(ellipsoid(&drag), drag.coefficient, drag.air_density_kg_m3);
        assert!(found.iter().zip(drag.semi_axes_m).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    }
}
