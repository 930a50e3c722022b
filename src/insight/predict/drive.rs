//! The thrust command of a flight, as its motors or rotors say it. The collective command that a flight controller
//! received is not what the rotors got: it moves it with the rates, boosts and compensates it.

use crate::flight::series::{held, last_at};
use crate::insight::diagnose::prediction::record::FlightRecord;
use crate::insight::prepare::data::Data;
use crate::insight::prepare::flight::PreparedFlight;
use crate::insight::prepare::rotors::{columns, command_per_speed};
use crate::model::vehicle::Vehicle;
use crate::model::vehicle::identified::{RotorChain, ThrustSource};

/// What stamps a command before a sample of the same time, s.
const BEFORE_S: f64 = 1e-6;

/// What drives the thrust of `vehicle` in these flights: the motors where it was identified with them and all flights
/// have them; the rotors where their speed is the only command; else the command.
pub fn source(data: &Data, vehicle: &Vehicle) -> ThrustSource {
    let Some(chain) = chain(vehicle) else { return ThrustSource::Command };
    let all = |has: &dyn Fn(&PreparedFlight) -> bool| data.flights.iter().all(has);
    if chain.command_per_speed.is_some() && all(&|f| command_per_speed(&f.quality.log).is_some()) {
        ThrustSource::Speeds
    } else if chain.rotor_lag_s.is_some() && all(&|f| columns(&f.quality.log.motors).is_some()) {
        ThrustSource::Motors
    } else {
        ThrustSource::Command
    }
}

fn chain(vehicle: &Vehicle) -> Option<RotorChain> {
    vehicle.identified.as_ref().and_then(|identified| identified.rotors)
}

/// Puts the command that the motors or rotors stand for into the record.
pub fn apply(source: ThrustSource, vehicle: &Vehicle, flight: &PreparedFlight, record: &mut FlightRecord) {
    let log = &flight.quality.log;
    let Some(chain) = chain(vehicle) else { return };
    let (stream, command): (_, Box<dyn Fn(f64, f64) -> f64>) = match source {
        ThrustSource::Command => return,
        ThrustSource::Motors => (&log.motors, Box::new(move |m, v| 2.0 * chain.command(m, v) - 1.0)),
        ThrustSource::Speeds => {
            let scale = chain.command_per_speed.unwrap_or(0.0);
            (&log.rotors, Box::new(move |w, _| 2.0 * w * scale - 1.0))
        }
    };
    let Some(columns) = columns(stream) else { return };
    let middle = 0.5 * (vehicle.battery.full_v + vehicle.battery.empty_v);
    let volts = held(&flight.time, &flight.voltage, &stream.time_s);
    let one = |i: usize| {
        let v = if volts[i].is_finite() { volts[i] } else { middle };
        let commands: Vec<f64> = columns.iter().map(|m| command(m[i], v)).filter(|u| u.is_finite()).collect();
        equal(vehicle, &commands, v)
    };
    let thrust: Vec<(f64, f64)> = (0..stream.len()).map(|i| (stream.time_s[i] - BEFORE_S, one(i))).collect();
    record.sent = merged(&record.sent, &thrust);
    record.commanded[1] = true;
}

/// The one command with the thrust of these together, by halving: thrust grows with the command.
fn equal(vehicle: &Vehicle, commands: &[f64], volts: f64) -> f64 {
    let n = commands.len() as f64;
    let inside = || commands.iter().map(|u| u.clamp(-1.0, 1.0));
    let wanted = inside().map(|u| vehicle.thrust_at(u, volts)).sum::<f64>() / n;
    let (mut low, mut high) = (inside().fold(1.0, f64::min), inside().fold(-1.0, f64::max));
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        *(if vehicle.thrust_at(middle, volts) < wanted { &mut low } else { &mut high }) = middle;
    }
    if n > 0.0 { 0.5 * (low + high) } else { f64::NAN }
}

/// The commands with `thrust` in place of their own, at the times of both.
fn merged(sent: &[(f64, [f64; 4])], thrust: &[(f64, f64)]) -> Vec<(f64, [f64; 4])> {
    let times: Vec<f64> = thrust.iter().map(|(t, _)| *t).collect();
    let mut out: Vec<(f64, [f64; 4])> = Vec::with_capacity(sent.len() + thrust.len());
    let mut at = 0;
    let mut now = sent.first().map_or([0.0; 4], |first| first.1);
    for (i, &(t, u)) in thrust.iter().enumerate() {
        while at < sent.len() && sent[at].0 <= t {
            now = sent[at].1;
            let before = last_at(&times, sent[at].0).map_or(u, |k| thrust[k].1);
            out.push((sent[at].0, [now[0], now[1], now[2], before]));
            at += 1;
        }
        if u.is_finite() {
            out.push((t, [now[0], now[1], now[2], thrust[i].1]));
        }
    }
    out.extend(sent[at..].iter().map(|(t, row)| (*t, [row[0], row[1], row[2], thrust.last().map_or(-1.0, |l| l.1)])));
    out
}
