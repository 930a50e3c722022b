//! From states to the streams of a log, through the sensors.

use super::Flown;
use crate::flight::instruments::{Actual, Instruments};
use crate::flight::sensors::SensorConfig;
use crate::flight::{Log, VehicleKind, VehicleRecord};
use crate::model::attitude::{body_axes, dot};
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::{Craft, Factors, State};
use crate::model::vehicle::Vehicle;

/// Records a flight, control step by control step.
pub struct Recorder<'a> {
    instruments: Instruments<'a>,
    /// The vehicle, at rest at the origin to begin with, in steps of the IMU.
    pub craft: Craft<f64>,
    /// Steps of the IMU in a control step.
    fine_steps: usize,
    controls: usize,
    resting: bool,
    log: Log,
    top_speed: f64,
}

impl<'a> Recorder<'a> {
    /// A recorder of a flight of the nominal `vehicle`; `seed` decides all errors of the sensors.
    pub fn new(vehicle: &Vehicle, sensors: &'a SensorConfig, seed: u64) -> Self {
        let fine_steps = (sensors.imu.rate_hz * CONTROL_S).round() as usize;
        let record = VehicleRecord {
            mass_kg: Some(vehicle.mass_kg),
            max_rate_rad_s: Some(vehicle.max_rates_rad_s()),
            kind: Some(VehicleKind::Multirotor),
            rotors: None,
        };
        let voltage = vehicle.battery.full_v;
        let state = State::new([0.0; 3], [0.0; 3], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], voltage);
        Recorder {
            instruments: Instruments::new(sensors, seed),
            craft: Craft::new(vehicle, &Factors::NOMINAL, CONTROL_S / fine_steps as f64, state),
            fine_steps,
            controls: 0,
            resting: false,
            log: Log { name: vehicle.name.clone(), vehicle: record, ..Log::default() },
            top_speed: 0.0,
        }
    }

    /// Time recorded so far, s.
    pub fn time_s(&self) -> f64 {
        self.controls as f64 * CONTROL_S
    }

    /// Whether the ground carries the vehicle.
    pub fn resting(&self) -> bool {
        self.resting
    }

    /// Puts the vehicle on the ground, or lets it go.
    pub fn rest(&mut self, resting: bool) {
        self.resting = resting;
    }

    /// Flies and records 10 ms with `command` held.
    pub fn hold(&mut self, command: [f64; 4]) {
        let max = self.craft.parameters().max_rate;
        let [roll, pitch, yaw, thrust] = command;
        let row = [roll * max[0], pitch * max[1], yaw * max[2], 0.5 + 0.5 * thrust];
        self.log.setpoint.push(self.time_s(), row);
        for k in 0..self.fine_steps {
            self.sense(self.time_s() + k as f64 * self.craft.parameters().dt);
            let State { position, attitude, .. } = self.craft.state;
            self.craft.step(command);
            if self.resting {
                self.craft.state = State { position, velocity: [0.0; 3], attitude, ..self.craft.state };
            }
        }
        self.controls += 1;
    }

    fn sense(&mut self, time_s: f64) {
        let State { position, velocity, attitude, .. } = self.craft.state;
        let (body_rates, specific_force) = if self.resting {
            ([0.0; 3], body_axes(attitude).map(|axis| axis[2] * self.craft.parameters().gravity))
        } else {
            (self.craft.body_rates(), self.craft.specific_force())
        };
        let voltage = self.craft.terminal_voltage();
        let actual = Actual { position, velocity, attitude, body_rates, specific_force, voltage };
        self.instruments.read(time_s, &actual, &mut self.log);
        self.top_speed = self.top_speed.max(dot(velocity, velocity).sqrt());
    }

    /// The flight.
    pub fn finish(self, laps: Vec<f64>, failure: Option<&'static str>) -> Flown {
        Flown { seconds: self.time_s(), log: self.log, top_speed: self.top_speed, laps, failure }
    }
}
