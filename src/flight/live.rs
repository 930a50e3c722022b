//! A policy that flies a vehicle: states in, setpoints out, at the policy's rate. `docs/flying.md` draws the states.
//!
//! [`Live`] has neither socket nor clock, so that every transition can be tested; `pace` brings both. A protocol is one
//! file, which turns bytes into what was [`heard`](heard::Heard) and an [`Answer`] into bytes.

pub mod answer;
pub mod duty;
pub mod endpoint;
pub mod guard;
pub mod heard;
pub mod histogram;
pub mod link;
pub mod mavlink;
pub mod msp;
pub mod pace;
pub mod packets;
pub mod phase;
pub mod port;
pub mod protocol;
mod record;
pub mod ros2;
pub mod route;
pub mod switch;

use crate::learn::nn::Network;
use crate::model::constants::CONTROL_S;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::race::env::observe::OBSERVATIONS;
use crate::race::onboard::{AT_START, Crossing, Memory, Onboard, Setpoint, Surroundings};
use answer::Answer;
use guard::{Guard, Limits};
use heard::Heard;
use histogram::Histogram;
use link::Link;
use phase::{Machine, Phase, Reason};
use record::Record;

/// What flies, and where.
#[derive(Clone, Debug)]
pub struct Mission {
    pub network: Network<f32>,
    pub track: Track,
    pub vehicle: Vehicle,
    /// Least and greatest of every entry of the observation in the training's flights.
    pub range: [[f32; OBSERVATIONS]; 2],
    /// Laps after which the flight is over; none: until something else ends it.
    pub laps: Option<u32>,
    /// Periods from the switch to the flight, which motors take to arm and to spin up.
    pub lead: u32,
}

/// A flight from the first state to its end.
#[derive(Debug)]
pub struct Live<'a> {
    mission: &'a Mission,
    around: &'a Surroundings,
    memory: Memory,
    guard: Guard,
    pub machine: Machine,
    pub link: Link,
    pub record: Record,
    /// Gates passed in flight.
    pub gates: u32,
    /// When they were, s, interpolated within the period.
    pub passes: Vec<f64>,
    /// Age of the estimate that an answer was made of, s.
    pub ages: Histogram,
}

impl<'a> Live<'a> {
    /// Before the first state. `around` is of the mission's track and vehicle.
    pub fn new(mission: &'a Mission, around: &'a Surroundings) -> Self {
        Self {
            mission,
            around,
            memory: Memory::before(0, AT_START),
            guard: Guard::new(Limits::of(&mission.track, &mission.vehicle)),
            machine: Machine::new(mission.lead),
            link: Link::default(),
            record: Record::default(),
            gates: 0,
            passes: Vec::new(),
            ages: Histogram::default(),
        }
    }

    /// What arrived at `now_s`.
    pub fn receive(&mut self, heard: Heard, now_s: f64) {
        if let Some(sight) = self.link.receive(heard, now_s) {
            // By the sender's clock: what came late did not move faster.
            self.guard.look(&sight.estimate, sight.time_us as f64 * 1e-6);
            self.record.state(now_s, &sight.estimate);
        }
    }

    /// One control period at `now_s`: what to send. `key` is whether the user asked for an end.
    pub fn tick(&mut self, now_s: f64, key: bool) -> Answer {
        let before = self.machine.phase;
        let sight = self.link.newest();
        let age_s = self.link.age_s(now_s);
        let hold = match sight {
            Some(sight) => self.guard.before(&sight.estimate, age_s),
            None => Some(Reason::NoState),
        };
        let switch = self.link.held(now_s);
        self.machine.advance(hold, switch, key);
        if (before, self.machine.phase) == (Phase::Ready, Phase::Flying) {
            self.memory = Memory::before(0, AT_START);
            self.gates = 0;
            self.passes.clear();
        }
        let setpoint = self.flying_step(now_s, age_s);
        let Machine { phase, reason, .. } = self.machine;
        let armed = self.machine.armed(switch);
        Answer { phase, reason, armed, time_us: sight.map_or(0, |sight| sight.time_us), setpoint }
    }

    /// The setpoint, where the policy has the vehicle before and after this step.
    fn flying_step(&mut self, now_s: f64, age_s: f64) -> Option<Setpoint> {
        let sight = self.link.newest().filter(|_| self.machine.phase == Phase::Flying)?;
        let (network, around) = (&self.mission.network, self.around);
        let mut onboard = Onboard { network, around, memory: self.memory };
        let answer = onboard.step(&sight.estimate);
        self.memory = onboard.memory;
        self.ages.add(age_s);
        if answer.crossing == Crossing::Passed {
            self.gates += 1;
            self.passes.push(now_s - CONTROL_S * (1.0 - f64::from(answer.fraction)));
        }
        let laps = self.mission.laps.map(|laps| laps * self.around.gates.len() as u32 + 1);
        let end = match answer.crossing {
            Crossing::Missed => Some(Reason::MissedGate),
            _ if laps.is_some_and(|gates| self.gates >= gates) => Some(Reason::LapsDone),
            _ => self.guard.after(&answer.observation, &self.mission.range),
        };
        if let Some(reason) = end {
            self.machine.end(reason);
            return None;
        }
        self.record.setpoint(now_s, &answer.setpoint);
        Some(answer.setpoint)
    }
}
