//! Vehicles with known truth, and random ones.

use super::thrust;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;

/// A quadrotor of the compact model, and what its logs say of it.
#[derive(Clone, Debug)]
pub struct Vehicle {
    pub mass: f64,
    pub gravity: f64,
    /// c0..c5 of Eq. 7, N.
    pub thrust_n: [f64; 6],
    /// Roll, pitch, yaw, thrust, s.
    pub tau: [f64; 4],
    /// Body rates that full commands lead to, rad/s.
    pub max_rate: [f64; 3],
    /// Body rates that full commands are meant to lead to, rad/s: what setpoints are recorded in.
    pub configured_rate: [f64; 3],
    pub semi_axes: [f64; 3],
    pub drag_coefficient: f64,
    pub air_density: f64,
    pub full_v: f64,
    pub empty_v: f64,
    /// V/s.
    pub voltage_rate: f64,
}

/// What identification is to find.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// Roll, pitch, yaw, thrust, s.
    pub time_constant_s: [f64; 4],
    pub max_rate_rad_s: [f64; 3],
    /// c0..c5 over the mass, m/s2.
    pub thrust_per_mass: [f64; 6],
    /// Drag acceleration over speed squared for flow along x, y, z, 1/m.
    pub drag_per_m: [f64; 3],
    /// Voltage at the start of the log, V, and its change, V/s.
    pub voltage: [f64; 2],
}

/// Time in which the battery goes from full to empty, s.
const DISCHARGE_S: f64 = 300.0;

impl Vehicle {
    /// The numbers of `configs/vehicles/seed_class.toml`, discharged in 300 s, whose rates are as configured.
    pub fn seed_class() -> Self {
        let max_rate = [618.0_f64, 618.0, 120.0].map(f64::to_radians);
        Vehicle {
            mass: 1.0,
            gravity: 9.80665,
            thrust_n: [-16.103, -19.048, 2.7408, 0.68433, 1.4129, 1.5693],
            tau: [0.0067, 0.0121, 0.0124, 0.0168],
            max_rate,
            configured_rate: max_rate,
            semi_axes: [0.11, 0.11, 0.045],
            drag_coefficient: 1.6,
            air_density: 1.2,
            full_v: 24.0,
            empty_v: 22.0,
            voltage_rate: -2.0 / DISCHARGE_S,
        }
    }

    /// A random vehicle: time constants of 5 to 25 ms, rates of 420 to 950 (yaw 120 to 600) deg/s within 5 % of the
    /// configured ones, 3 to 7 times its weight in thrust, 4 or 6 cells; the rest within 20 % of the seed class.
    pub fn draw(seed: u64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed);
        let mut v = Self::seed_class();
        let mut near = |x: f64| x * rng.random_range(0.8..1.2);
        v.mass = near(v.mass);
        v.semi_axes = v.semi_axes.map(&mut near);
        v.drag_coefficient = near(v.drag_coefficient);
        v.tau = v.tau.map(|_| log_range(&mut rng, 0.005, 0.025));
        let fast = [(420.0, 950.0), (420.0, 950.0), (120.0, 600.0)];
        v.configured_rate = fast.map(|(low, high)| log_range(&mut rng, low, high).round().to_radians());
        v.max_rate = v.configured_rate.map(|rate| rate * rng.random_range(0.95..1.05));
        let (full, empty) = if rng.random_bool(0.5) { (25.0, 22.0) } else { (16.7, 14.6) };
        v.full_v = full + rng.random_range(-0.3..0.2);
        v.empty_v = empty + rng.random_range(-0.3..0.3);
        v.voltage_rate = (v.empty_v - v.full_v) / DISCHARGE_S;
        v.draw_thrust(&mut rng);
        v
    }

    /// Varies the seed class's curve until it grows with the command, and from little.
    fn draw_thrust(&mut self, rng: &mut StdRng) {
        let seed = Self::seed_class();
        let same_thrust = (seed.full_v + seed.empty_v) / (self.full_v + self.empty_v);
        let mut strength = rng.random_range(3.0..7.0);
        for attempt in 1u64.. {
            // Some strengths have no plausible curve near the seed class's.
            if attempt % 10_000 == 0 {
                strength = rng.random_range(3.0..7.0);
            }
            self.thrust_n = seed.thrust_n.map(|c| c * rng.random_range(0.8..1.2));
            self.thrust_n[4] *= same_thrust;
            self.thrust_n[5] *= same_thrust;
            let scale = strength * self.gravity / thrust::per_mass(self, 1.0, self.full_v);
            self.thrust_n = self.thrust_n.map(|c| c * scale);
            if scale > 0.0 && [self.full_v, self.empty_v].iter().all(|&volts| self.plausible(volts)) {
                return;
            }
        }
    }

    fn plausible(&self, volts: f64) -> bool {
        let at = |k: i32| thrust::per_mass(self, f64::from(k) / 50.0, volts);
        let idle = at(-50) / self.gravity;
        (0.0..0.3).contains(&idle) && at(50) / self.gravity > 2.5 && (-50..50).all(|k| at(k + 1) > at(k))
    }

    /// The command whose thrust over mass is `wanted` (m/s2) at `volts`.
    pub fn command_for(&self, wanted: f64, volts: f64) -> f64 {
        let [mut low, mut high] = [-1.0, 1.0];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if thrust::per_mass(self, middle, volts) < wanted { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Thrust over mass at full throttle in the middle of the pack, m/s2.
    pub fn thrust_at_full(&self) -> f64 {
        thrust::per_mass(self, 1.0, 0.5 * (self.full_v + self.empty_v))
    }

    /// The same vehicle in the crate's terms.
    pub fn in_racer(&self) -> racer::model::vehicle::Vehicle {
        let mut vehicle = racer::model::vehicle::Vehicle::load("seed_class").expect("built in");
        vehicle.name = "true".into();
        vehicle.mass_kg = self.mass;
        vehicle.gravity_m_s2 = self.gravity;
        vehicle.thrust_n = self.thrust_n;
        let [roll, pitch, yaw, thrust] = self.tau;
        vehicle.time_constant_s = racer::model::vehicle::TimeConstants { roll, pitch, yaw, thrust };
        let [roll, pitch, yaw] = self.max_rate.map(f64::to_degrees);
        vehicle.max_rate_deg_s = racer::model::vehicle::MaxRates { roll, pitch, yaw };
        vehicle.drag.semi_axes_m = self.semi_axes;
        vehicle.drag.coefficient = self.drag_coefficient;
        vehicle.drag.air_density_kg_m3 = self.air_density;
        vehicle.battery.full_v = self.full_v;
        vehicle.battery.empty_v = self.empty_v;
        vehicle.battery.rate_v_s = self.voltage_rate;
        vehicle
    }

    pub fn truth(&self) -> Truth {
        let [a, b, c] = self.semi_axes;
        let factor = 0.5 * self.air_density * self.drag_coefficient * PI / self.mass;
        Truth {
            time_constant_s: self.tau,
            max_rate_rad_s: self.max_rate,
            thrust_per_mass: self.thrust_n.map(|c| c / self.mass),
            drag_per_m: [factor * b * c, factor * a * c, factor * a * b],
            voltage: [self.full_v, self.voltage_rate],
        }
    }
}

fn log_range(rng: &mut StdRng, low: f64, high: f64) -> f64 {
    rng.random_range(low.ln()..high.ln()).exp()
}
