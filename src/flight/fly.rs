//! Flying in the simulator and recording what a real vehicle's log would hold.

mod recorder;

use crate::base::check::BadInput;
use crate::base::lane::{Level, dispatch};
use crate::flight::Log;
use crate::flight::pilot::{Manoeuvre, Pilot, PilotLimits, Seen};
use crate::flight::sensors::SensorConfig;
use crate::learn::nn::Network;
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::State;
use crate::model::thrust::specific_thrust;
use crate::model::vehicle::Vehicle;
use crate::race::env::Race;
use crate::race::env::reset::StartPlace;
use crate::race::env::terminate::CAUSES;
use crate::race::heat;
use recorder::Recorder;

/// A recorded flight.
#[derive(Clone, Debug)]
pub struct Flown {
    pub log: Log,
    /// Length of the flight, s.
    pub seconds: f64,
    /// Largest speed, m/s.
    pub top_speed: f64,
    /// Times from one crossing of the first gate to the next, s.
    pub laps: Vec<f64>,
    /// Why a race ended before its time, one of [`CAUSES`].
    pub failure: Option<&'static str>,
}

/// A manoeuvre that was flown, from the approach to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlownManoeuvre {
    pub kind: Manoeuvre,
    /// From when to when, s.
    pub span_s: [f64; 2],
}

/// Longest flight, s.
pub const LONGEST_S: f64 = 3600.0;
/// Time that is recorded after the landing, s.
const AFTER_S: f64 = 1.0;

/// The excitation pilot flies `kinds` of manoeuvres, all where none is named, from the ground until it has landed, for
/// at most `seconds`. It lands early where the battery is empty before.
pub fn by_pilot(vehicle: &Vehicle, sensors: &SensorConfig, kinds: &[Manoeuvre], seed: u64, seconds: f64) -> Flown {
    let mut pilot = Pilot::new(seed, limits(vehicle, seconds)).only(kinds);
    piloted(vehicle, sensors, &mut pilot, seed, seconds)
}

/// The excitation pilot flies exactly these manoeuvres in this order, for at most `seconds`, and lands; with what was
/// flown when. It lands early where the battery is empty before.
pub fn in_order(
    vehicle: &Vehicle,
    sensors: &SensorConfig,
    order: &[Manoeuvre],
    seed: u64,
    seconds: f64,
) -> (Flown, Vec<FlownManoeuvre>) {
    let mut pilot = Pilot::new(seed, limits(vehicle, seconds)).in_order(order);
    let flown = piloted(vehicle, sensors, &mut pilot, seed, seconds);
    let begun = pilot.begun();
    let ends = begun.iter().skip(1).map(|(_, from)| *from).chain([pilot.landing_s().unwrap_or(flown.seconds)]);
    let manoeuvres = begun.iter().zip(ends).map(|(&(kind, from), to)| FlownManoeuvre { kind, span_s: [from, to] });
    let manoeuvres = manoeuvres.collect();
    (flown, manoeuvres)
}

/// What the pilot knows of a vehicle.
fn limits(vehicle: &Vehicle, seconds: f64) -> PilotLimits {
    let battery = &vehicle.battery;
    PilotLimits {
        max_rate_rad_s: vehicle.max_rates_rad_s(),
        hover_command: vehicle.hover_command(0.5 * (battery.full_v + battery.empty_v)),
        seconds,
        empty_v: battery.empty_v,
    }
}

fn piloted(vehicle: &Vehicle, sensors: &SensorConfig, pilot: &mut Pilot, seed: u64, seconds: f64) -> Flown {
    let mut recorder = Recorder::new(vehicle, sensors, seed);
    recorder.rest(true);
    let mut landed_s = 0.0;
    while recorder.time_s() < seconds - 0.5 * CONTROL_S && landed_s < AFTER_S {
        let rates = if recorder.resting() { [0.0; 3] } else { recorder.craft.body_rates() };
        let State { position, velocity, attitude, voltage, .. } = recorder.craft.state;
        let seen = Seen { time_s: recorder.time_s(), position, velocity, attitude, rates, voltage };
        let command = pilot.command(&seen);
        recorder.hold(command);
        settle(&mut recorder);
        landed_s = if pilot.landed() { landed_s + CONTROL_S } else { 0.0 };
    }
    recorder.finish(Vec::new(), None)
}

/// Shortest flight of the pilot, s: it needs half of that for taking off and landing.
const SHORTEST_PILOT_S: f64 = 40.0;

/// Fails where `seconds`, given at `place`, are too few for the pilot.
pub fn check_pilot(place: &str, seconds: f64) -> Result<(), BadInput> {
    if (SHORTEST_PILOT_S..=LONGEST_S).contains(&seconds) {
        return Ok(());
    }
    let expected = format!("{SHORTEST_PILOT_S} to {LONGEST_S} s");
    Err(BadInput::new(place, format!("{seconds} s"), &expected, "the pilot takes off, flies, and lands"))
}

/// The ground at height 0: it carries what thrust does not lift, and stops what comes down.
fn settle(recorder: &mut Recorder) {
    let resting = recorder.resting();
    let parameters = recorder.craft.parameters();
    let state = &recorder.craft.state;
    let lifts = specific_thrust(&parameters.thrust, state.command[3], state.voltage) > parameters.gravity;
    if resting && lifts {
        recorder.rest(false);
    } else if state.position[2] < 0.0 && !lifts {
        let state = &mut recorder.craft.state;
        let [w, _, _, z] = state.attitude;
        // Level, with the heading that it came down with.
        let norm = w.hypot(z).max(1e-9);
        state.attitude = [w / norm, 0.0, 0.0, z / norm];
        state.position[2] = 0.0;
        state.velocity = [0.0; 3];
        recorder.rest(true);
    }
}

/// A policy's deterministic mean races from the pad, lap after lap, until it fails or for `seconds`. The states at 100
/// Hz are those of the race, so that it flies as in an evaluation; what lies between is integrated from each of them.
pub fn by_policy(
    level: Level,
    race: &Race,
    network: &Network<f32>,
    sensors: &SensorConfig,
    seed: u64,
    seconds: f64,
) -> Flown {
    let steps = (seconds / race.dt).round() as usize;
    let fly = heat::Heat {
        race,
        network,
        place: StartPlace::Pad,
        first: 0,
        vehicles: 1,
        steps,
        gates: usize::MAX,
        seen: false,
    };
    let raced = dispatch(level, fly).remove(0);
    let mut recorder = Recorder::new(&race.vehicle, sensors, seed);
    for (craft, command, _) in &raced.steps {
        recorder.craft.resume(craft, f64::from);
        recorder.hold(command.map(f64::from));
    }
    let crossings: Vec<f64> = raced.passes.iter().step_by(race.gates.len()).copied().collect();
    let laps = crossings.windows(2).map(|pair| pair[1] - pair[0]).collect();
    recorder.finish(laps, raced.failure.map(|cause| CAUSES[cause]))
}
