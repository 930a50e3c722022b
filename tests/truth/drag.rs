//! Drag of an ellipsoid in still air.

use super::vehicle::Vehicle;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Area of the silhouette along the unit vector `n`, m2. The ellipsoid is the sphere of radius 1 mapped by
/// A = diag(semi-axes); a plane's area maps by the cofactors, so the disk of area pi becomes pi |cof(A) n|.
pub fn silhouette(semi_axes: [f64; 3], n: &Vector3<f64>) -> f64 {
    let [a, b, c] = semi_axes;
    let cofactors = Vector3::new(b * c, c * a, a * b);
    PI * cofactors.component_mul(n).norm()
}

/// Drag over mass, body frame, m/s2, at the body-frame velocity through the air.
pub fn per_mass(vehicle: &Vehicle, air: &Vector3<f64>) -> Vector3<f64> {
    let speed = air.norm();
    if speed < 1e-9 {
        return Vector3::zeros();
    }
    let along = air / speed;
    let pressure = 0.5 * vehicle.air_density * speed * speed;
    -along * (pressure * vehicle.drag_coefficient * silhouette(vehicle.semi_axes, &along) / vehicle.mass)
}

/// The same where each axis brakes for itself: along it as much as [`per_mass`], and nothing that turns with the flow.
pub fn by_axis(vehicle: &Vehicle, air: &Vector3<f64>) -> Vector3<f64> {
    let along = |axis: Vector3<f64>| silhouette(vehicle.semi_axes, &axis);
    let areas = Vector3::new(along(Vector3::x()), along(Vector3::y()), along(Vector3::z()));
    let pressure_by_speed = 0.5 * vehicle.air_density * air.norm();
    -areas.component_mul(air) * (pressure_by_speed * vehicle.drag_coefficient / vehicle.mass)
}
