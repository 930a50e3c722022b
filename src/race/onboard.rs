//! The flight side of a policy: what a flight computer does with it a hundred times a second. States in, setpoints out;
//! gates, history and the filtered command are kept here.
//!
//! Exports say the same in other languages, and are held against this.

use crate::base::lane::{LANES, Lane, Portable, build};
use crate::learn::nn::Network;
use crate::learn::policy::ACTIONS;
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::response;
use crate::model::thrust::specific_thrust;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::race::act::act;
use crate::race::env::gates::{self, GateFrame};
use crate::race::env::observe::{self, OBSERVATIONS, ObservationInputs};

/// What a flight computer knows of its vehicle. World frame ENU, body frame front-left-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// World, m.
    pub position: [f32; 3],
    /// World, m/s.
    pub velocity: [f32; 3],
    /// Body to world, as w, x, y, z.
    pub attitude: [f32; 4],
    /// About the body's axes, rad/s.
    pub body_rates: [f32; 3],
    /// At the battery's terminals, V.
    pub voltage: f32,
}

/// What a flight controller is to be sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setpoint {
    /// About the body's axes, rad/s.
    pub body_rates: [f32; 3],
    /// 0, no throttle, to 1, full throttle.
    pub throttle: f32,
    /// Thrust that this throttle settles at with the present voltage, N, and over the weight.
    pub thrust_n: f32,
    pub thrust_to_weight: f32,
}

/// What is around the network: all numbers but the weights.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// With the full apertures.
    pub gates: Vec<GateFrame<f32>>,
    /// Offset and scale of the observed voltage.
    pub voltage_scale: [f64; 2],
    /// Share of the gap to its action that a filtered command closes in a step.
    pub share: [f64; ACTIONS],
    /// Rate setpoints that an action of 1 stands for, rad/s.
    pub full_rate: [f64; 3],
    /// c0..c5 of the thrust, N.
    pub thrust_n: [f64; 6],
    pub weight_n: f64,
}

impl Surroundings {
    /// Of a policy for `track` in `vehicle`.
    pub fn of(track: &Track, vehicle: &Vehicle) -> Self {
        let asked = vehicle.identified.as_ref().map(|origin| origin.full_rate_deg_s.map(f64::to_radians));
        Self {
            gates: gates::frames(track, None),
            voltage_scale: observe::voltage_scale(&vehicle.battery),
            share: vehicle.time_constants().map(|tau| response::alpha(tau, CONTROL_S)),
            full_rate: asked.unwrap_or_else(|| vehicle.max_rates_rad_s()),
            thrust_n: vehicle.thrust_n,
            weight_n: vehicle.mass_kg * vehicle.gravity_m_s2,
        }
    }

    /// What `action` asks of the vehicle at `voltage`.
    pub fn setpoint(&self, action: [f32; ACTIONS], voltage: f32) -> Setpoint {
        let thrust = specific_thrust(&self.thrust_n, f64::from(action[3]), f64::from(voltage));
        Setpoint {
            body_rates: build!(|i| action[i] * self.full_rate[i] as f32),
            throttle: 0.5 * (action[3] + 1.0),
            thrust_n: thrust as f32,
            thrust_to_weight: (thrust / self.weight_n) as f32,
        }
    }
}

/// What is kept from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory {
    /// Filtered commands.
    pub command: [f32; ACTIONS],
    /// The last three actions, newest first.
    pub history: [[f32; ACTIONS]; 3],
    /// The gate that comes next.
    pub target: usize,
    /// World, m; none before the first step.
    pub position: Option<[f32; 3]>,
}

/// Command and history on the pad: rates of zero, no thrust.
pub const AT_START: [f32; ACTIONS] = [0.0, 0.0, 0.0, -1.0];

impl Memory {
    /// Before `target`, where `command` was held long enough.
    pub fn before(target: usize, command: [f32; ACTIONS]) -> Self {
        Self { command, history: [command; 3], target, position: None }
    }
}

/// How the last move met the plane of the target gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    None,
    /// Through the aperture: the next gate is the target now.
    Passed,
    /// Outside the aperture: the target stays.
    Missed,
}

/// One step's answer.
#[derive(Clone, Copy, Debug)]
pub struct Decision {
    pub crossing: Crossing,
    /// Share of the last move that lay before the plane; meaningful where it was crossed.
    pub fraction: f32,
    /// The gate that was flown to.
    pub target: usize,
    pub observation: [f32; OBSERVATIONS],
    pub action: [f32; ACTIONS],
    pub setpoint: Setpoint,
}

/// A policy in flight.
#[derive(Clone, Debug)]
pub struct Onboard<'a> {
    pub network: &'a Network<f32>,
    pub around: &'a Surroundings,
    pub memory: Memory,
}

impl Onboard<'_> {
    /// One control period: where the vehicle is, what it is to be told.
    pub fn step(&mut self, now: &Estimate) -> Decision {
        let (crossing, fraction) = self.cross(now.position);
        let observation = self.observe(now);
        let action = act(self.network, &[observation])[0];
        let target = self.memory.target;
        let command = self.memory.command;
        let share = self.around.share.map(|share| share as f32);
        self.memory.command = build!(|i| response::toward(command[i], action[i], share[i]));
        self.memory.history = [action, self.memory.history[0], self.memory.history[1]];
        self.memory.position = Some(now.position);
        let setpoint = self.around.setpoint(action, now.voltage);
        Decision { crossing, fraction, target, observation, action, setpoint }
    }

    /// Compares the last two positions with the target gate, and goes on to the next where it was passed.
    fn cross(&mut self, position: [f32; 3]) -> (Crossing, f32) {
        let Some(before) = self.memory.position else { return (Crossing::None, 0.0) };
        let gate = &self.around.gates[self.memory.target];
        let met = gates::crossing(gate.locate(before), gate.locate(position), gate.radius);
        if met.passed {
            self.memory.target = (self.memory.target + 1) % self.around.gates.len();
        }
        let crossing = match (met.passed, met.missed) {
            (true, _) => Crossing::Passed,
            (_, true) => Crossing::Missed,
            _ => Crossing::None,
        };
        (crossing, met.fraction)
    }

    fn observe(&self, now: &Estimate) -> [f32; OBSERVATIONS] {
        type L = Portable<f32>;
        let gate = &self.around.gates[self.memory.target];
        let seen = ObservationInputs {
            in_gate: gate.locate(now.position).map(L::splat),
            gate: &gate.map(L::splat),
            velocity: now.velocity.map(L::splat),
            attitude: now.attitude.map(L::splat),
            body_rates: now.body_rates.map(L::splat),
            command: &self.memory.command.map(L::splat),
            history: &self.memory.history.map(|action| action.map(L::splat)),
            voltage: L::splat(now.voltage),
        };
        let mut out = [0.0; OBSERVATIONS * LANES];
        observe::observe(&seen, None, self.around.voltage_scale, &mut out, LANES);
        build!(|k| out[k * LANES])
    }
}
