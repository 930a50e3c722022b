//! From states to the streams of a log, through the sensors.

use super::Flown;
use crate::base::rng::{self, Philox, Sequence};
use crate::flight::sensors::SensorConfig;
use crate::flight::{Log, Stream, VehicleKind, VehicleRecord};
use crate::model::attitude::{body_axes, compose, dot, normalized, small_rotation};
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::{Craft, Factors, State};
use crate::model::vehicle::Vehicle;

/// Records a flight, control step by control step.
pub struct Recorder<'a> {
    sensors: &'a SensorConfig,
    /// The vehicle, at rest at the origin to begin with, in steps of the IMU.
    pub craft: Craft<f64>,
    /// Steps of the IMU in a control step.
    fine_steps: usize,
    controls: usize,
    resting: bool,
    /// Random numbers of the streams, so that no stream's settings change another's errors.
    imu: Sequence,
    odometry: Sequence,
    battery: Sequence,
    bias: Bias,
    log: Log,
    top_speed: f64,
}

struct Bias {
    gyro: [f64; 3],
    specific_force: [f64; 3],
    position: [f64; 3],
    velocity: [f64; 3],
    attitude: [f64; 3],
    voltage: [f64; 1],
}

impl<'a> Recorder<'a> {
    /// A recorder of a flight of the nominal `vehicle`; `seed` decides all errors of the sensors.
    pub fn new(vehicle: &Vehicle, sensors: &'a SensorConfig, seed: u64) -> Self {
        let fine_steps = (sensors.imu.rate_hz * CONTROL_S).round() as usize;
        let rng = Philox::new(seed);
        let mut sequences = [0, 1, 2].map(|stream| rng.sequence(rng::RngStream::Sensors, stream, 0));
        let bias = Bias {
            gyro: sensors.imu.gyro.draw_bias(&mut sequences[0]),
            specific_force: sensors.imu.specific_force.draw_bias(&mut sequences[0]),
            position: sensors.odometry.position.draw_bias(&mut sequences[1]),
            velocity: sensors.odometry.velocity.draw_bias(&mut sequences[1]),
            attitude: sensors.odometry.attitude.channel().draw_bias(&mut sequences[1]),
            voltage: sensors.battery.voltage.draw_bias(&mut sequences[2]),
        };
        let [imu, odometry, battery] = sequences;
        let record = VehicleRecord {
            mass_kg: Some(vehicle.mass_kg),
            max_rate_rad_s: Some(vehicle.max_rates_rad_s()),
            kind: Some(VehicleKind::Multirotor),
            rotors: None,
        };
        let voltage = vehicle.battery.full_v;
        let state = State::new([0.0; 3], [0.0; 3], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], voltage);
        Recorder {
            sensors,
            craft: Craft::new(vehicle, &Factors::NOMINAL, CONTROL_S / fine_steps as f64, state),
            fine_steps,
            controls: 0,
            resting: false,
            imu,
            odometry,
            battery,
            bias,
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
        let SensorConfig { imu, odometry, battery } = self.sensors;
        let (craft, state) = (&self.craft, &self.craft.state);
        let (rates, force) = if self.resting {
            ([0.0; 3], body_axes(state.attitude).map(|axis| axis[2] * craft.parameters().gravity))
        } else {
            (craft.body_rates(), craft.specific_force())
        };
        let [p, q, r] = imu.gyro.read(rates, self.bias.gyro, &mut self.imu);
        let [x, y, z] = imu.specific_force.read(force, self.bias.specific_force, &mut self.imu);
        self.log.imu.push(time_s, [p, q, r, x, y, z]);
        self.top_speed = self.top_speed.max(dot(state.velocity, state.velocity).sqrt());

        if due(&self.log.odometry, odometry.rate_hz, time_s) {
            let [x, y, z] = odometry.position.read(state.position, self.bias.position, &mut self.odometry);
            let turn = odometry.attitude.channel().read([0.0; 3], self.bias.attitude, &mut self.odometry);
            let [qw, qx, qy, qz] = normalized(compose(state.attitude, small_rotation(turn, 1.0)));
            let body = body_axes(state.attitude).map(|axis| dot(axis, state.velocity));
            let [u, v, w] = odometry.velocity.read(body, self.bias.velocity, &mut self.odometry);
            self.log.odometry.push(time_s, [x, y, z, qw, qx, qy, qz, u, v, w]);
        }
        if due(&self.log.battery, battery.rate_hz, time_s) {
            let [voltage] = battery.voltage.read([craft.terminal_voltage()], self.bias.voltage, &mut self.battery);
            self.log.battery.push(time_s, [voltage, f64::NAN]);
        }
    }

    /// The flight.
    pub fn finish(self, laps: Vec<f64>, failure: Option<&'static str>) -> Flown {
        Flown { seconds: self.time_s(), log: self.log, top_speed: self.top_speed, laps, failure }
    }
}

/// Whether the next sample of a stream is due, at the latest by a millionth of its period.
fn due<const N: usize>(stream: &Stream<N>, rate_hz: f64, time_s: f64) -> bool {
    stream.len() as f64 <= time_s * rate_hz + 1e-6
}
