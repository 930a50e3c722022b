//! A vehicle, and the compact model that somebody who identified it would have.

use super::faults::Faults;
use super::plant::Plant;
use super::{STEP_S, motors};
use crate::truth::Vehicle;
use nalgebra::{DMatrix, DVector};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;

/// See the module.
#[derive(Clone, Debug)]
pub struct Airframe {
    pub mass: f64,
    /// Thrust of all motors at full speed of a full pack, N.
    pub full_n: f64,
    /// Speed at closed throttle as a share of full.
    pub idle: f64,
    /// Time constant of a motor, s.
    pub motor_s: f64,
    /// Angular acceleration that opposite motors at full difference give, rad/s2.
    pub authority: [f64; 3],
    /// Turning by rotors that speed up, s of the yaw authority.
    pub rotor_lead_s: f64,
    /// Bandwidth of the rate loop, rad/s.
    pub bandwidth: [f64; 3],
    /// Full stick, rad/s.
    pub max_rate: [f64; 3],
    pub semi_axes: [f64; 3],
    pub drag_coefficient: f64,
    pub full_v: f64,
    pub empty_v: f64,
    /// V/s.
    pub discharge: f64,
}

pub const GRAVITY: f64 = 9.80665;
pub const AIR_DENSITY: f64 = 1.2;

impl Airframe {
    pub fn draw(seed: u64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed ^ 0xa1f);
        let mass = rng.random_range(0.55..1.1);
        let roll = rng.random_range(350.0..700.0);
        let fast = rng.random_range(450.0..850.0_f64).to_radians();
        let (full, empty) = if rng.random_bool(0.5) { (25.0, 22.0) } else { (16.7, 14.6) };
        Airframe {
            mass,
            full_n: mass * GRAVITY * rng.random_range(3.5..7.0),
            idle: rng.random_range(0.04..0.1),
            motor_s: rng.random_range(0.015..0.03),
            authority: [roll, roll * rng.random_range(0.8..1.1), rng.random_range(50.0..90.0)],
            rotor_lead_s: rng.random_range(0.005..0.02),
            bandwidth: [rng.random_range(40.0..70.0), rng.random_range(40.0..70.0), rng.random_range(15.0..30.0)],
            max_rate: [fast, fast, rng.random_range(150.0..400.0_f64).to_radians()],
            semi_axes: [0.11, 0.11, 0.045].map(|a: f64| a * rng.random_range(0.8..1.2)),
            drag_coefficient: rng.random_range(1.2..1.8),
            full_v: full,
            empty_v: empty,
            discharge: (empty - full) / 300.0,
        }
    }

    /// Drag force over the square of the speed along each axis, N s2/m2.
    pub fn drag(&self) -> [f64; 3] {
        let [a, b, c] = self.semi_axes;
        [b * c, a * c, a * b].map(|area| 0.5 * AIR_DENSITY * self.drag_coefficient * PI * area)
    }

    /// The compact model nearest to it.
    pub fn nominal(&self) -> Vehicle {
        let [roll, pitch, yaw] = std::array::from_fn(|axis| self.response(axis));
        Vehicle {
            mass: self.mass,
            gravity: GRAVITY,
            thrust_n: self.thrust_curve(),
            tau: [roll, pitch, yaw, self.motor_s],
            max_rate: self.max_rate,
            configured_rate: self.max_rate,
            semi_axes: self.semi_axes,
            drag_coefficient: self.drag_coefficient,
            air_density: AIR_DENSITY,
            full_v: self.full_v,
            empty_v: self.empty_v,
            voltage_rate: self.discharge,
        }
    }

    /// Least squares of the thrust over commands and voltages of the first fifth of the pack.
    fn thrust_curve(&self) -> [f64; 6] {
        let mut rows = Vec::new();
        let mut thrust = Vec::new();
        for i in 0..=40 {
            for j in 0..=6 {
                let (u, volts) = (f64::from(i) / 20.0 - 1.0, self.full_v + 10.0 * f64::from(j) * self.discharge);
                rows.extend([1.0, u, u * u, u * u * u, volts, u * volts]);
                thrust.push(self.full_n * motors::speed(self, 0.5 + 0.5 * u, volts).powi(2));
            }
        }
        let matrix = DMatrix::from_row_slice(thrust.len(), 6, &rows);
        let found = matrix.svd(true, true).solve(&DVector::from_vec(thrust), 1e-12).expect("both sides were asked for");
        std::array::from_fn(|k| found[k])
    }

    /// Mean delay of a rate after a step of its stick in hover, s.
    fn response(&self, axis: usize) -> f64 {
        let none = Faults::new(&[], 0, 1.0);
        let mut plant = Plant::hovering(self);
        let mut command = [0.0, 0.0, 0.0, plant.hover_command(self)];
        command[axis] = 0.15;
        plant.controller.send(0.0, command, &none);
        let mut missing = 0.0;
        for k in 0..400 {
            plant.step(self, &none, f64::from(k) * STEP_S);
            missing += (1.0 - plant.rates[axis] / (0.15 * self.max_rate[axis])) * STEP_S;
        }
        missing.clamp(0.006, 0.08)
    }
}
