//! Flights with something hidden in them: the simulator with every term of [`effects::terms`](super::effects::terms).
//!
//! pilot -> [`link`] -> [`inner`] or [`motors`] -> [`thrust`], [`battery`], [`air`] -> [`motion`] -> [`sense`], each in
//! its file.

pub mod air;
pub mod battery;
pub mod craft;
pub mod held;
pub mod inflow;
pub mod inner;
pub mod link;
pub mod motion;
pub mod motors;
pub mod race;
pub mod sense;
pub mod thrust;
pub mod weather;

use super::effects::Hidden;
use super::effects::terms::Terms;
use super::{CONTROL_S, STEPS, Vehicle};
pub use craft::Craft;
pub use held::Flight;
use link::Link;
use motion::Inputs;
use motors::Controller;
use race::Racer;
use racer::flight::pilot::{Pilot, PilotLimits, Seen};
use racer::flight::{Log, VehicleRecord};
use sense::Sensors;
use weather::Weather;

/// How it is flown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// By the pilot that excites everything.
    Excited,
    /// Along a racing line, without any excitation.
    Race,
}

/// A flight.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Decides manoeuvres, errors, phases, rates of all streams but the IMU's, and the weather.
    pub seed: u64,
    pub seconds: f64,
    /// Scales the noise of all sensors: 1 is realistic, 0 none but sampling.
    pub noise: f64,
    pub imu_hz: f64,
    pub style: Style,
}

/// A vehicle and what is hidden in it.
#[derive(Clone, Debug)]
pub struct World {
    pub vehicle: Vehicle,
    pub terms: Terms,
}

impl World {
    pub fn new(vehicle: &Vehicle, hidden: &[Hidden]) -> Self {
        World { vehicle: vehicle.clone(), terms: Terms::of(hidden) }
    }
}

/// The log of a flight of `vehicle` with all of `hidden` in it.
pub fn fly(vehicle: &Vehicle, hidden: &[Hidden], setting: &Setting) -> Log {
    match setting.style {
        Style::Excited => fly_as(vehicle, hidden, setting, |pilot| pilot),
        Style::Race => {
            let world = World::new(vehicle, hidden);
            let mut time_s = 0.0;
            let mut racer = Racer::new(vehicle, setting.seed);
            record(&world, setting, &mut |craft| {
                let command = racer.command(&seen(craft, &world, time_s));
                time_s += CONTROL_S;
                command
            })
        }
    }
}

/// The same by the pilot that `told` makes of the one that excites everything.
pub fn fly_as(vehicle: &Vehicle, hidden: &[Hidden], setting: &Setting, told: impl FnOnce(Pilot) -> Pilot) -> Log {
    let world = World::new(vehicle, hidden);
    // Who flies knows the vehicle without what is hidden, and lands by the clock: a sagging pack is no empty one.
    let limits = PilotLimits { empty_v: 0.0, ..super::limits(vehicle, setting.seed, setting.seconds) };
    let mut pilot = told(Pilot::new(setting.seed, limits));
    let mut time_s = 0.0;
    record(&world, setting, &mut |craft| {
        let command = pilot.command(&seen(craft, &world, time_s));
        time_s += CONTROL_S;
        command
    })
}

fn seen(craft: &Craft, world: &World, time_s: f64) -> Seen {
    let q = craft.attitude;
    Seen {
        time_s,
        position: craft.position.into(),
        velocity: craft.velocity.into(),
        attitude: [q.w, q.i, q.j, q.k],
        rates: inner::body_rates(craft, &world.terms).into(),
        voltage: battery::terminal(craft, world, time_s),
    }
}

/// Flies what `human` commands (roll, pitch, yaw rate, thrust in [-1, 1]) from rest on the ground.
pub fn record(world: &World, setting: &Setting, human: &mut dyn FnMut(&Craft) -> [f64; 4]) -> Log {
    let vehicle = &world.vehicle;
    let mut log = Log { name: "flight".into(), start_ns: 1_700_000_000_000_000_000, ..Log::default() };
    log.vehicle = VehicleRecord {
        mass_kg: Some(vehicle.mass),
        max_rate_rad_s: Some(vehicle.configured_rate),
        ..VehicleRecord::default()
    };
    let mut sensors = Sensors::new(setting, world);
    let mut link = Link::new(&world.terms, setting.seed);
    let mut weather = Weather::new(&world.terms, setting.seed);
    let mut controller = Controller::default();
    let mut craft = Craft::on_ground();
    let dt = CONTROL_S / STEPS as f64;
    for control in 0..(setting.seconds / CONTROL_S).round() as usize {
        let time = control as f64 * CONTROL_S;
        let command = human(&craft);
        let [x, y, z] = vehicle.configured_rate;
        log.setpoint.push(time, [command[0] * x, command[1] * y, command[2] * z, 0.5 + 0.5 * command[3]]);
        link.send(time, command);
        for k in 0..STEPS {
            let now = time + k as f64 * dt;
            let air = weather.next(dt);
            let motors = controller.next(&craft, world, &link, now, dt);
            let inputs = Inputs { link: &link, air, motors };
            sensors.sense(now, dt, &|due| motion::flow(&craft, world, &inputs, now, due), &inputs, world, &mut log);
            craft = motion::flow(&craft, world, &inputs, now, now + dt);
        }
    }
    log
}
