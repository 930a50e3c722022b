//! What a vehicle's file does not say, and its motors need: inertia, and where four rotors push.

use crate::base::check::{Check, Invalid};
use crate::model::attitude::cross;
use crate::model::vehicle::Vehicle;
use serde::{Deserialize, Serialize};

/// Where each rotor is along x and y (front and left are above zero), and which way its torque turns the vehicle, in
/// Betaflight's order: rear right, front right, rear left, front left.
const ROTORS: [[f64; 3]; 4] = [[-1.0, -1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, 1.0]];

/// A frame with four equal rotors at its corners.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Airframe {
    /// About body x, y, z, kg m2.
    pub inertia_kg_m2: [f64; 3],
    /// From the centre of mass to a rotor, m.
    pub arm_m: f64,
    /// Torque of a rotor over its thrust, m.
    pub torque_m: f64,
}

/// Of a small propeller: its torque over its thrust, m, between measured racers of 5 inches (0.012 to 0.022).
const TORQUE_M: f64 = 0.016;

impl Airframe {
    /// Derived from `vehicle`: inertia of an even ellipsoid with the drag's semi-axes, rotors at the end of its longer
    /// horizontal one. For a racer of 0.75 kg that gives 0.0021, 0.0021, 0.0036 kg m2; 0.0025, 0.0021, 0.0043 were
    /// measured (NeuroBEM).
    pub fn of(vehicle: &Vehicle) -> Self {
        let [a, b, c] = vehicle.drag.semi_axes_m.map(|axis| axis * axis * vehicle.mass_kg / 5.0);
        let [x, y, _] = vehicle.drag.semi_axes_m;
        Self { inertia_kg_m2: [b + c, a + c, a + b], arm_m: x.max(y), torque_m: TORQUE_M }
    }

    /// Change of the body rates, rad/s2, under the rotors' thrusts, N.
    pub fn turning(&self, thrusts: [f64; 4], rates: [f64; 3]) -> [f64; 3] {
        let lever = self.arm_m * std::f64::consts::FRAC_1_SQRT_2;
        let sum = |weight: &dyn Fn(&[f64; 3]) -> f64| -> f64 {
            ROTORS.iter().zip(thrusts).map(|(rotor, thrust)| weight(rotor) * thrust).sum()
        };
        let torque = [sum(&|[_, y, _]| y * lever), sum(&|[x, _, _]| -x * lever), sum(&|[_, _, z]| z * self.torque_m)];
        let spin = cross(rates, std::array::from_fn(|i| self.inertia_kg_m2[i] * rates[i]));
        std::array::from_fn(|i| (torque[i] - spin[i]) / self.inertia_kg_m2[i])
    }
}

impl Check for Airframe {
    fn check(&self) -> Result<(), Invalid> {
        for (axis, value) in self.inertia_kg_m2.into_iter().enumerate() {
            Invalid::unless_positive(&format!("inertia_kg_m2[{axis}]"), value, "")?;
        }
        Invalid::unless_positive("arm_m", self.arm_m, "")?;
        Invalid::unless_positive("torque_m", self.torque_m, "")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pair_of_rotors_turns_its_own_way() {
        let frame = Airframe { inertia_kg_m2: [1.0; 3], arm_m: 2.0_f64.sqrt(), torque_m: 0.1 };
        let turning = |thrusts| frame.turning(thrusts, [0.0; 3]).map(|x| (10.0 * x).round() / 10.0);
        // Left rotors roll right, rear ones pitch down, those that turn clockwise yaw left: all above zero.
        assert_eq!(turning([0.0, 0.0, 1.0, 1.0]), [2.0, 0.0, 0.0]);
        assert_eq!(turning([1.0, 0.0, 1.0, 0.0]), [0.0, 2.0, 0.0]);
        assert_eq!(turning([1.0, 0.0, 0.0, 1.0]), [0.0, 0.0, 0.2]);
        assert_eq!(turning([5.0; 4]), [0.0; 3]);
    }
}
