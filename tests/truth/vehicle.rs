//! The true vehicle.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

pub const GRAVITY: f64 = 9.80665;

#[derive(Clone, Debug)]
pub struct Vehicle {
    pub mass: f64,
    /// Roll, pitch, yaw, thrust, s.
    pub tau: [f64; 4],
    /// What a full stick asks for, and what it gets, rad/s.
    pub full_rate: [f64; 3],
    pub max_rate: [f64; 3],
    /// Thrust in newtons as a polynomial of command and volts: 1, u, u^2, u^3, V, u V.
    pub thrust: [f64; 6],
    /// Ellipsoid: semi-axes (m), drag coefficient, air density (kg/m3).
    pub semi_axes: [f64; 3],
    pub drag_coefficient: f64,
    pub density: f64,
    /// Volts at take-off, and volts a second.
    pub full_v: f64,
    pub discharge: f64,
}

impl Vehicle {
    /// About the published racing quadrotor, every number drawn anew.
    pub fn random(seed: u64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed);
        let mut around = |x: f64, spread: f64| x * rng.random_range(1.0 - spread..1.0 + spread);
        let full_v: f64 = if around(1.0, 0.5) > 1.0 { 25.0 } else { 16.6 };
        let cells = full_v / 25.0;
        let full_rate = [around(650.0, 0.3), around(650.0, 0.3), around(250.0, 0.5)].map(f64::to_radians);
        let mass = around(0.8, 0.3);
        // Thrust over weight at full throttle and full pack, and its shape: a share of it follows the voltage.
        let weight = mass * GRAVITY;
        let (most, idle) = (around(5.0, 0.35) * weight, around(0.08, 0.5) * weight);
        let (square, cube) = (around(0.14, 0.3), around(-0.03, 0.6));
        let follows = around(1.2, 0.2) / full_v;
        // Shape from 0 at u = -1 to 1 at u = 1: 1/2 + a u + b u^2 + c u^3 with a = 1/2 - c and b taken from the constant.
        let span = most - idle;
        let flat = [0.5 - square, 0.5 - cube, square, cube].map(|x| x * span);
        // The voltage scales the straight part: (0.45 + 0.45 u) span follows (V - full).
        let share = 0.45 * span * follows;
        let thrust = [flat[0] + idle - share * full_v, flat[1] - share * full_v, flat[2], flat[3], share, share];
        Vehicle {
            mass,
            tau: [around(0.012, 0.5), around(0.014, 0.5), around(0.016, 0.4), around(0.02, 0.4)],
            max_rate: full_rate.map(|rate| around(rate, 0.06)),
            full_rate,
            thrust,
            semi_axes: [around(0.11, 0.2), around(0.11, 0.2), around(0.045, 0.2)],
            drag_coefficient: around(1.6, 0.25),
            density: 1.2,
            full_v,
            discharge: -around(0.0125, 0.2) * cells,
        }
    }

    /// Thrust over mass at filtered command `u`, m/s2.
    pub fn push(&self, u: f64, volts: f64) -> f64 {
        let [a, b, c, d, e, f] = self.thrust;
        (a + b * u + c * u.powi(2) + d * u.powi(3) + e * volts + f * u * volts) / self.mass
    }

    /// Drag over mass along each axis for motion along it, 1/m.
    pub fn drag_over_mass(&self) -> [f64; 3] {
        let [a, b, c] = self.semi_axes;
        [b * c, c * a, a * b].map(|s| std::f64::consts::PI * s * self.drag_coefficient * self.density / 2.0 / self.mass)
    }

    /// The command that carries the weight, by a search over a fine grid.
    pub fn hover(&self, volts: f64) -> f64 {
        let off = |u: &f64| (self.push(*u, volts) - GRAVITY).abs();
        (0..=4000).map(|i| -1.0 + f64::from(i) / 2000.0).min_by(|x, y| off(x).total_cmp(&off(y))).unwrap()
    }
}
