//! The vehicle motor by motor: the simulator's equations with four rotors in place of the rate loop, which a flight
//! controller closes.
//!
//! Each rotor takes its own command with the thrust's lag and gives a quarter of the thrust curve. Their sum is flown
//! as the one collective command of the same thrust, so that forces, drag, battery and motion are the simulator's own.
//! Of a vehicle's effects, those on the way from a setpoint to body rates are the flight controller's and play no part.

use super::airframe::Airframe;
use crate::base::lane::build;
use crate::flight::instruments::Actual;
use crate::model::attitude::{Quaternion, body_axes, dot};
use crate::model::dynamics::extended::{
    Drive, Extended, ForceInputs, RigidBody, TurnError, actuator_response, elapsed, force, moved, terminal,
};
use crate::model::dynamics::{Factors, battery};
use crate::model::thrust::specific_thrust;
use crate::model::vehicle::Vehicle;

/// A vehicle and its state.
#[derive(Clone, Debug)]
pub struct Plant {
    pub body: RigidBody<f64>,
    /// Body rates, rad/s.
    pub rates: [f64; 3],
    /// Whether the ground carries it.
    pub resting: bool,
    /// Filtered command of each rotor, -1..1.
    rotors: [f64; 4],
    /// Battery voltage without load, and lost to slow polarisation, V.
    open_v: f64,
    polarisation_v: f64,
    equations: Extended<f64>,
    airframe: Airframe,
    mass_kg: f64,
}

impl Plant {
    /// `vehicle` at rest on the ground there, its battery full, for steps of `dt` seconds.
    pub fn new(vehicle: &Vehicle, airframe: Airframe, dt: f64, position: [f64; 3], attitude: Quaternion<f64>) -> Self {
        Self {
            body: RigidBody { position, velocity: [0.0; 3], attitude },
            rates: [0.0; 3],
            resting: true,
            rotors: [-1.0; 4],
            open_v: vehicle.battery.full_v,
            polarisation_v: 0.0,
            equations: Extended::new(vehicle, &Factors::NOMINAL, dt),
            airframe,
            mass_kg: vehicle.mass_kg,
        }
    }

    /// A step in which each motor is sent so much, 0..1.
    pub fn step(&mut self, motors: [f64; 4]) {
        let p = &self.equations;
        let h = p.compact.dt;
        let rate_v_s = if self.resting { 0.0 } else { p.compact.voltage_rate };
        let open = battery::discharged(self.open_v, rate_v_s, 0.5 * h);
        let (voltage, polarisation) = terminal(p, open, self.collective(&self.rotors), self.polarisation_v, h);
        let turned = |i: usize| {
            let sent = [0.0, 0.0, 0.0, 2.0 * motors[i].clamp(0.0, 1.0) - 1.0];
            actuator_response(p, [0.0, 0.0, 0.0, self.rotors[i]], [0.0; 3], sent, voltage, h).0[3]
        };
        let rotors: [f64; 4] = build!(|i| turned(i));
        let middle: [f64; 4] = build!(|i| 0.5 * (self.rotors[i] + rotors[i]));
        let command = self.collective(&middle);
        self.rotors = rotors;
        self.open_v = battery::discharged(open, rate_v_s, 0.5 * h);
        self.polarisation_v = polarisation;
        let lifts = specific_thrust(&p.compact.thrust, command, voltage) > p.compact.gravity;
        self.resting &= !lifts;
        if self.resting {
            return;
        }
        let thrusts = middle.map(|u| 0.25 * self.mass_kg * specific_thrust(&p.compact.thrust, u, voltage));
        let turning = self.airframe.turning(thrusts, self.rates);
        let rates = build!(|i| turning[i].mul_add(0.5 * h, self.rates[i]));
        let (height, elapsed) = (self.body.position[2], elapsed(p, open));
        // What a setpoint asks for is not known to the motors.
        let drive = Drive { command, voltage, rates, height, turn_error: TurnError::none(), elapsed };
        self.body = moved(&self.body, p, &drive, h);
        self.rates = build!(|i| turning[i].mul_add(h, self.rates[i]));
        if self.body.position[2] < 0.0 && !lifts {
            self.land();
        }
    }

    /// The one command that gives the mean of the rotors' thrusts. Thrust grows with the command.
    fn collective(&self, rotors: &[f64; 4]) -> f64 {
        let thrust = |u: f64| specific_thrust(&self.equations.compact.thrust, u, self.open_v);
        let mean = rotors.iter().map(|&u| thrust(u)).sum::<f64>() / 4.0;
        let mut low = rotors.iter().copied().fold(1.0, f64::min);
        let mut high = rotors.iter().copied().fold(-1.0, f64::max);
        while high - low > 1e-9 {
            let middle = 0.5 * (low + high);
            *(if thrust(middle) < mean { &mut low } else { &mut high }) = middle;
        }
        0.5 * (low + high)
    }

    /// Level on the ground, with the heading that it came down with.
    fn land(&mut self) {
        let [w, _, _, z] = self.body.attitude;
        let norm = w.hypot(z).max(1e-9);
        self.body.attitude = [w / norm, 0.0, 0.0, z / norm];
        self.body.position[2] = 0.0;
        (self.body.velocity, self.rates, self.resting) = ([0.0; 3], [0.0; 3], true);
    }

    /// Voltage at the battery's terminals, V.
    pub fn voltage(&self) -> f64 {
        terminal(&self.equations, self.open_v, self.collective(&self.rotors), self.polarisation_v, 0.0).0
    }

    /// What sensors could measure of it.
    pub fn actual(&self) -> Actual {
        let RigidBody { position, velocity, attitude } = self.body;
        let (axes, voltage) = (body_axes(attitude), self.voltage());
        let p = &self.equations;
        let specific_force = if self.resting {
            axes.map(|axis| axis[2] * p.compact.gravity)
        } else {
            let inputs = ForceInputs {
                command: self.collective(&self.rotors),
                voltage,
                axes,
                velocity: axes.map(|axis| dot(axis, velocity)),
                rates: self.rates,
                height: position[2],
                turn_error: TurnError::none(),
                elapsed: elapsed(p, self.open_v),
            };
            force(p, &inputs)
        };
        Actual { position, velocity, attitude, body_rates: self.rates, specific_force, voltage }
    }
}
