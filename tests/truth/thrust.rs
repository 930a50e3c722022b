//! Collective thrust.

use super::vehicle::Vehicle;

/// Thrust over mass at the response `u` and `volts`, m/s2: a cubic in u, shifted and steepened by the voltage.
pub fn per_mass(vehicle: &Vehicle, u: f64, volts: f64) -> f64 {
    let [c0, c1, c2, c3, c4, c5] = vehicle.thrust_n;
    (c0 + c1 * u + c2 * u.powi(2) + c3 * u.powi(3) + c4 * volts + c5 * u * volts) / vehicle.mass
}
