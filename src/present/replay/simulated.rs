//! A policy's race, to be shown.

use super::{Replay, ReplayFrame, ReplayVehicle, laps};
use crate::base::lane::{Level, dispatch};
use crate::learn::nn::Network;
use crate::model::track::Track;
use crate::race::env::Race;
use crate::race::env::reset::StartPlace;
use crate::race::env::terminate::CAUSES;
use crate::race::heat::{Heat, Raced};

/// `network` races on `track` in `vehicles` vehicles, at most [`crate::race::heat::MOST`], for at most `seconds`; with
/// `one_lap` only until it has completed a lap. The first vehicle is nominal, the others are those of an evaluation;
/// `race` is made scored first.
pub fn race(
    level: Level,
    race: &Race,
    track: &Track,
    network: &Network<f32>,
    vehicles: usize,
    seconds: f64,
    one_lap: bool,
) -> Replay {
    let race = race.scored(track);
    let steps = (seconds / race.dt).round() as usize;
    let gates = if one_lap { track.gates.len() + 1 } else { usize::MAX };
    let raced = dispatch(
        level,
        Heat { race: &race, network, place: StartPlace::Pad, first: 0, vehicles, steps, gates, seen: true },
    );
    let name = |i: usize| if i == 0 { race.vehicle.name.clone() } else { format!("randomised {i}") };
    let vehicles = raced.iter().enumerate().map(|(i, raced)| vehicle(name(i), raced, track, race.dt)).collect();
    Replay {
        title: format!("{} on {}", race.vehicle.name, track.name),
        start_ns: 0,
        track: Some(track.clone()),
        vehicles,
    }
}

fn vehicle(name: String, raced: &Raced, track: &Track, dt: f64) -> ReplayVehicle {
    let frames = raced.steps.iter().enumerate().map(|(step, (craft, command, target))| ReplayFrame {
        time_s: step as f64 * dt,
        position: craft.state.position.map(f64::from),
        velocity: craft.state.velocity.map(f64::from),
        attitude: craft.state.attitude.map(f64::from),
        rates: craft.body_rates().map(f64::from),
        command: command.map(f64::from),
        voltage: f64::from(craft.terminal_voltage()),
        target: Some(*target as usize),
        observation: raced.seen.get(step).copied(),
    });
    let gates = track.gates.len();
    let passes: Vec<_> = raced.passes.iter().enumerate().map(|(i, &time)| (time, i % gates)).collect();
    let failure = raced.failure.map(|cause| CAUSES[cause].replace('_', " "));
    ReplayVehicle { name, frames: frames.collect(), laps: laps(&passes), passes, failure }
}
