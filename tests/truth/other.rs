//! A third truth, of other making: a quadrotor motor by motor under its flight controller, whose log holds an
//! estimator's errors, clocks and lost packets. It has the causes of the catalogue in forms that the catalogue does
//! not have ([`causes`]).
//!
//! pilot -> [`controller`] -> [`motors`], [`pack`] -> [`air`] -> [`plant`] -> [`sense`], each in its file.

pub mod air;
pub mod airframe;
pub mod causes;
pub mod controller;
pub mod faults;
pub mod motors;
pub mod pack;
pub mod plant;
pub mod sense;

use super::effects::Hidden;
use super::hidden::{Setting, Style, race::Racer};
use super::{CONTROL_S, Vehicle};
pub use airframe::Airframe;
use faults::Faults;
use plant::Plant;
use racer::flight::pilot::{Pilot, PilotLimits, Seen};
use racer::flight::{Log, VehicleRecord};
use sense::Recorder;

/// Integration step, s; commands are held for so many.
pub const STEP_S: f64 = 0.0005;
const STEPS: usize = 20;

/// The log of a flight of `airframe` with all of `hidden` in it.
pub fn fly(airframe: &Airframe, hidden: &[Hidden], setting: &Setting) -> Log {
    let nominal = airframe.nominal();
    let limits = PilotLimits { empty_v: 0.0, ..super::limits(&nominal, setting.seed, setting.seconds) };
    match setting.style {
        Style::Excited => {
            let mut pilot = Pilot::new(setting.seed, limits);
            record(airframe, &nominal, hidden, setting, &mut |seen| pilot.command(seen))
        }
        Style::Race => {
            let mut racer = Racer::new(&nominal, setting.seed);
            record(airframe, &nominal, hidden, setting, &mut |seen| racer.command(seen))
        }
    }
}

/// What of a flight the pilot sees.
pub fn seen(plant: &Plant, time_s: f64) -> Seen {
    let q = plant.attitude;
    Seen {
        time_s,
        position: plant.position.into(),
        velocity: plant.velocity.into(),
        attitude: [q.w, q.i, q.j, q.k],
        rates: plant.rates.into(),
        voltage: plant.pack.volts,
    }
}

fn record(
    airframe: &Airframe,
    nominal: &Vehicle,
    hidden: &[Hidden],
    setting: &Setting,
    human: &mut dyn FnMut(&Seen) -> [f64; 4],
) -> Log {
    let mut log = Log { name: "flight".into(), start_ns: 1_700_000_000_000_000_000, ..Log::default() };
    let (mass_kg, max_rate_rad_s) = (Some(nominal.mass), Some(airframe.max_rate));
    log.vehicle = VehicleRecord { mass_kg, max_rate_rad_s, ..VehicleRecord::default() };
    let faults = Faults::new(hidden, setting.seed, setting.seconds);
    let mut plant = Plant::on_ground(airframe);
    let mut recorder = Recorder::new(setting);
    for control in 0..(setting.seconds / CONTROL_S).round() as usize {
        let time = control as f64 * CONTROL_S;
        let command = human(&seen(&plant, time));
        let [x, y, z] = airframe.max_rate;
        log.setpoint.push(time, [command[0] * x, command[1] * y, command[2] * z, 0.5 + 0.5 * command[3]]);
        plant.controller.send(time, command, &faults);
        for k in 0..STEPS {
            let now = time + k as f64 * STEP_S;
            plant.step(airframe, &faults, now);
            recorder.sense(&plant, airframe, &faults, now + STEP_S, &mut log);
        }
    }
    log
}
