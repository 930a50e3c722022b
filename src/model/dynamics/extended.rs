//! The compact model with effects that it lacks: one step, divided into parts that pass through the stages.

pub mod memory;
mod motion;
mod stages;

use super::{Factors, Parameters, State, battery};
use crate::base::lane::{Lane, Real, build, set_lanes};
use crate::model::effects::{self, EffectValues};
use crate::model::vehicle::Vehicle;

pub use memory::EffectMemory;
pub use motion::{Drive, RigidBody, moved};
pub use stages::{
    ForceInputs, TurnError, actuator_response, actuator_response_by, body_rates, command_delays, elapsed, force,
    loaded, specific_force, terminal, throttle,
};

/// Steps are divided until each is at most this long, s.
const FINE_S: f64 = 0.0021;

/// The extended model's numbers: those of the compact one, and more.
#[derive(Clone, Copy, Debug)]
pub struct Extended<R> {
    pub compact: Parameters<R>,
    /// Time constants of roll, pitch, yaw, thrust, s.
    pub tau: [R; 4],
    /// Open-circuit voltage of a full and of an empty battery, V.
    pub full_v: R,
    pub empty_v: R,
    /// The effects' parameters.
    pub values: EffectValues<R>,
    /// Parts that a step is divided into.
    parts: u32,
}

impl Extended<f64> {
    /// The numbers of `vehicle` with `factors` for steps of `dt` seconds.
    pub fn new(vehicle: &Vehicle, factors: &Factors, dt: f64) -> Self {
        let tau = vehicle.time_constants();
        let tau = build!(|i| tau[i] * factors.time_constant[i]);
        let effects = vehicle.effects.drawn(&factors.effects);
        Self::of(vehicle, Parameters::new(vehicle, factors, dt), tau, effects)
    }

    /// The same with all numbers given: the compact model's, time constants (s), and the effects'; of `vehicle` the
    /// battery is used.
    pub fn of(vehicle: &Vehicle, compact: Parameters<f64>, tau: [f64; 4], effects: [f64; effects::COUNT]) -> Self {
        let parts = (compact.dt / FINE_S).ceil() as u32;
        let battery = &vehicle.battery;
        let (full_v, empty_v) = (battery.full_v, battery.empty_v);
        Extended { compact, tau, full_v, empty_v, values: EffectValues::new(effects), parts }
    }
}

impl<R: Copy> Extended<R> {
    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> Extended<S> {
        Extended {
            compact: self.compact.map(&mut f),
            tau: self.tau.map(&mut f),
            full_v: f(self.full_v),
            empty_v: f(self.empty_v),
            values: self.values.map(&mut f),
            parts: self.parts,
        }
    }
}

impl<L: Lane> Extended<L> {
    /// Replaces the numbers of one lane.
    pub fn set_lane(&mut self, lane: usize, new: &Extended<L::Elem>) {
        self.compact.set_lane(lane, &new.compact);
        set_lanes(&mut self.tau, lane, &new.tau);
        self.full_v.set(lane, new.full_v);
        self.empty_v.set(lane, new.empty_v);
        self.values.set_lane(lane, &new.values);
        self.parts = new.parts;
    }
}

/// One step under the held command `action`: a function of its own, so that it is compiled once for each kind of number
/// and not again in every kernel that steps.
pub fn step<R: Real>(s: &mut State<R>, p: &Extended<R>, memory: &mut EffectMemory<R>, action: [R; 4]) {
    R::vectorize(
        #[inline(always)]
        || {
            let held = memory.hold(action, command_delays(p));
            let h = p.compact.dt * R::of(1.0 / f64::from(p.parts));
            for _ in 0..p.parts {
                let sent = memory.arriving(&held, h);
                part(s, p, memory, sent, h);
            }
        },
    )
}

/// `h` seconds while the commands `sent` arrive, with forces taken at the middle.
#[inline(always)]
fn part<R: Real>(s: &mut State<R>, p: &Extended<R>, memory: &mut EffectMemory<R>, sent: [R; 4], h: R) {
    let half = h * R::of(0.5);
    let open = battery::discharged(s.voltage, p.compact.voltage_rate, half);
    let (voltage, polarisation) = terminal(p, open, s.command[3], memory.polarisation, h);
    let (command, slope) = actuator_response(p, s.command, memory.slope, sent, voltage, h);
    let mean: [R; 4] = build!(|i| (s.command[i] + command[i]) * R::of(0.5));
    let rates = body_rates(p, mean);
    let turn_error = TurnError::of(p, memory.line[0], sent, mean);
    let (elapsed, height) = (elapsed(p, open), s.position[2]);
    let drive = Drive { command: mean[3], voltage, rates, height, turn_error, elapsed };
    let body = RigidBody { position: s.position, velocity: s.velocity, attitude: s.attitude };
    let RigidBody { position, velocity, attitude } = moved(&body, p, &drive, h);
    memory.slope = slope;
    memory.polarisation = polarisation;
    let voltage = battery::discharged(open, p.compact.voltage_rate, half);
    *s = State { position, velocity, attitude, command, voltage };
}
