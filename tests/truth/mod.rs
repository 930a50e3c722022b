//! An independent simulator: makes flight logs whose truth is known. It shares no equation with the crate; from there
//! it takes only the type of a log and, as the human at the sticks, the pilot.
//!
//! [`hidden`] is the same with effects that a diagnosis is to find ([`effects`]).
//!
//! command -> [`response`] -> [`thrust`], [`drag`] -> [`integrate`] -> [`sense`], each in its file.

// Every test that includes this uses its own part.
#![allow(dead_code, unused_imports)]

pub mod controlled;
pub mod drag;
pub mod effects;
pub mod hidden;
pub mod integrate;
pub mod other;
pub mod response;
pub mod sense;
pub mod state;
pub mod thrust;
pub mod vehicle;

use integrate::step;
use racer::flight::pilot::{Pilot, PilotLimits, Seen};
use racer::flight::{Log, VehicleRecord};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use sense::Sensors;
pub use state::State;
pub use vehicle::Vehicle;

/// Integration steps a command is held for: 2 kHz at 100 Hz.
pub const STEPS: usize = 20;
/// Control step, s.
pub const CONTROL_S: f64 = 0.01;

/// The pilot flies `vehicle` for `seconds`; `noise` scales the errors of all sensors (1 is realistic, 0 is none but
/// sampling). `seed` decides manoeuvres, errors, rates and phases.
pub fn fly(vehicle: &Vehicle, seed: u64, seconds: f64, noise: f64) -> Log {
    let mut pilot = Pilot::new(seed, limits(vehicle, seed, seconds));
    let mut time_s = 0.0;
    record(vehicle, seed, seconds, noise, &mut |state| {
        let command = pilot.command(&seen(state, vehicle, time_s));
        time_s += CONTROL_S;
        command
    })
}

/// What the pilot is told: a hover command that is up to 15 % of the weight off.
pub fn limits(vehicle: &Vehicle, seed: u64, seconds: f64) -> PilotLimits {
    let mut rng = StdRng::seed_from_u64(seed ^ 0x5eed);
    let volts = 0.5 * (vehicle.full_v + vehicle.empty_v);
    let hover = vehicle.command_for(vehicle.gravity * rng.random_range(0.85..1.15), volts);
    PilotLimits { max_rate_rad_s: vehicle.configured_rate, hover_command: hover, seconds, empty_v: vehicle.empty_v }
}

/// What the pilot sees at that moment.
pub fn seen(state: &State, vehicle: &Vehicle, time_s: f64) -> Seen {
    let q = state.attitude;
    Seen {
        time_s,
        position: state.position.into(),
        velocity: state.velocity.into(),
        attitude: [q.w, q.i, q.j, q.k],
        rates: state.rates(vehicle).into(),
        voltage: state.voltage,
    }
}

/// Flies what `human` commands (roll, pitch, yaw rate, thrust in [-1, 1]) from rest on the ground.
pub fn record(
    vehicle: &Vehicle,
    seed: u64,
    seconds: f64,
    noise: f64,
    human: &mut dyn FnMut(&State) -> [f64; 4],
) -> Log {
    let mut log = Log { name: format!("truth {seed}"), start_ns: 1_700_000_000_000_000_000, ..Log::default() };
    log.vehicle = VehicleRecord {
        mass_kg: Some(vehicle.mass),
        max_rate_rad_s: Some(vehicle.configured_rate),
        ..VehicleRecord::default()
    };
    let mut sensors = Sensors::new(seed, noise);
    let mut state = State::on_ground(vehicle);
    let dt = CONTROL_S / STEPS as f64;
    for control in 0..(seconds / CONTROL_S).round() as usize {
        let time = control as f64 * CONTROL_S;
        let command = human(&state);
        let [x, y, z] = vehicle.configured_rate;
        log.setpoint.push(time, [command[0] * x, command[1] * y, command[2] * z, 0.5 + 0.5 * command[3]]);
        for k in 0..STEPS {
            let now = time + k as f64 * dt;
            // A straight line between two steps would look like another time constant, by more than the fit's own
            // error.
            sensors.sense(now, dt, &|due| step(&state, vehicle, command, due - now), vehicle, &mut log);
            state = step(&state, vehicle, command, dt);
        }
    }
    log
}
