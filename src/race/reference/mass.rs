//! The point mass: what thrust a motion needs, and how much there is.

use crate::base::lane::{Real, build};
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::drag::damping_in_body;
use crate::model::dynamics::{Factors, Parameters};
use crate::model::thrust::specific_thrust;
use crate::model::vehicle::Vehicle;

/// A vehicle that turns at once: thrust of any direction, at most `thrust`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// Largest thrust over the mass, m/s2.
    pub thrust: f64,
    /// m/s2
    pub gravity: f64,
    /// Drag over the mass as deceleration over speed squared, 1/m.
    pub drag: f64,
}

/// Added to a velocity, m/s, so that it has a direction also where it is zero.
const NEVER_ZERO: f64 = 1e-9;

impl Mass {
    /// The nominal `vehicle` with the battery at `voltage` (V). Drag is that of the attitude which has the least: a
    /// vehicle that turns at once might as well fly in it, and none has less.
    pub fn new(vehicle: &Vehicle, voltage: f64) -> Self {
        // No number that is taken from it depends on the length of the step.
        let p = Parameters::new(vehicle, &Factors::NOMINAL, CONTROL_S);
        Mass {
            thrust: specific_thrust(&p.thrust, 1.0, voltage),
            gravity: p.gravity,
            drag: p.drag.into_iter().fold(f64::INFINITY, f64::min),
        }
    }

    /// The thrust over the mass that makes the acceleration `a` (m/s2) at the velocity `v` (m/s), both world; m/s2.
    pub fn thrust_for<R: Real>(&self, a: [R; 3], v: [R; 3]) -> [R; 3] {
        let free = [a[0], a[1], a[2] + R::of(self.gravity)];
        if self.drag == 0.0 {
            return free;
        }
        let v = [v[0] + R::of(NEVER_ZERO), v[1], v[2]];
        let damping = damping_in_body(&[R::of(self.drag); 3], v);
        build!(|i| damping.mul_add(v[i], free[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::dynamics::force_in_body;

    /// In its best attitude the simulator's vehicle brakes as the point mass does, and in every other more.
    #[test]
    fn thrust_and_drag_are_the_simulators() {
        let vehicle = Vehicle::load("seed_class").unwrap();
        let p = Parameters::new(&vehicle, &Factors::NOMINAL, CONTROL_S);
        let mass = Mass::new(&vehicle, 23.0);
        let pushed = force_in_body(&p.thrust, &p.drag, 1.0, 23.0, [0.0; 3]);
        assert_eq!(pushed, [0.0, 0.0, mass.thrust]);
        let speed = 15.0;
        let ours = mass.thrust_for([0.0, 0.0, -mass.gravity], [speed, 0.0, 0.0]);
        let shares = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.48, 0.6, 0.64]];
        let drags = shares.map(|share| {
            let force = force_in_body(&[0.0; 6], &p.drag, 0.0, 23.0, share.map(|x| x * speed));
            force.iter().map(|f| f * f).sum::<f64>().sqrt()
        });
        let least = drags.into_iter().fold(f64::INFINITY, f64::min);
        assert!((ours[0] - least).abs() < 1e-6 && ours[1] == 0.0 && ours[2] == 0.0, "{ours:?} {drags:?}");
    }
}
