//! First-order response of the inner loop.

use super::vehicle::Vehicle;
use nalgebra::Vector4;

/// Change of the responses, 1/s.
pub fn change(response: &Vector4<f64>, command: [f64; 4], vehicle: &Vehicle) -> Vector4<f64> {
    (Vector4::from(command) - response).component_div(&Vector4::from(vehicle.tau))
}
