//! Forms of an effect: what its equation leaves where nature has the same cause with another exponent or factor. They
//! are no dynamics. A diagnosis lets them bend a cause that it has found, so that what its form leaves is not taken for
//! another cause.

use super::AerodynamicForces;

/// A direction in which an effect can be bent.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    pub name: &'static str,
    pub unit: &'static str,
    /// A size that is about that of a small effect.
    pub typical: f64,
    pub of: FormOf,
}

/// What a bend adds, for each unit of it.
#[derive(Clone, Copy, Debug)]
pub enum FormOf {
    /// To the specific force, body frame; from what acts on the vehicle, thrust included.
    Force(fn(&AerodynamicForces<f64>) -> [f64; 3]),
    /// To the voltage at the terminals; from the load (0..1) and the charge (0..1).
    Voltage(fn(f64, f64) -> f64),
}

impl Form {
    pub const fn force(
        name: &'static str,
        unit: &'static str,
        typical: f64,
        of: fn(&AerodynamicForces<f64>) -> [f64; 3],
    ) -> Self {
        Self { name, unit, typical, of: FormOf::Force(of) }
    }

    pub const fn voltage(name: &'static str, typical: f64, of: fn(f64, f64) -> f64) -> Self {
        Self { name, unit: "V", typical, of: FormOf::Voltage(of) }
    }
}
