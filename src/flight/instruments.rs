//! A simulated vehicle's sensors at work: what they read of it, into a log.

use crate::base::rng::{Philox, RngStream, Sequence};
use crate::flight::sensors::SensorConfig;
use crate::flight::{Log, Stream};
use crate::model::attitude::{Quaternion, body_axes, compose, dot, normalized, small_rotation};

/// What there is to measure.
#[derive(Clone, Copy, Debug)]
pub struct Actual {
    /// World, m and m/s.
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    pub attitude: Quaternion<f64>,
    /// Body, rad/s.
    pub body_rates: [f64; 3],
    /// Body, m/s2.
    pub specific_force: [f64; 3],
    /// At the battery's terminals, V.
    pub voltage: f64,
}

/// Sensors with the errors of one flight.
#[derive(Debug)]
pub struct Instruments<'a> {
    sensors: &'a SensorConfig,
    /// Random numbers of the streams, so that no stream's settings change another's errors.
    imu: Sequence,
    odometry: Sequence,
    battery: Sequence,
    bias: Bias,
}

#[derive(Debug)]
struct Bias {
    gyro: [f64; 3],
    specific_force: [f64; 3],
    position: [f64; 3],
    velocity: [f64; 3],
    attitude: [f64; 3],
    voltage: [f64; 1],
}

impl<'a> Instruments<'a> {
    /// `seed` decides all errors.
    pub fn new(sensors: &'a SensorConfig, seed: u64) -> Self {
        let rng = Philox::new(seed);
        let mut sequences = [0, 1, 2].map(|stream| rng.sequence(RngStream::Sensors, stream, 0));
        let bias = Bias {
            gyro: sensors.imu.gyro.draw_bias(&mut sequences[0]),
            specific_force: sensors.imu.specific_force.draw_bias(&mut sequences[0]),
            position: sensors.odometry.position.draw_bias(&mut sequences[1]),
            velocity: sensors.odometry.velocity.draw_bias(&mut sequences[1]),
            attitude: sensors.odometry.attitude.channel().draw_bias(&mut sequences[1]),
            voltage: sensors.battery.voltage.draw_bias(&mut sequences[2]),
        };
        let [imu, odometry, battery] = sequences;
        Self { sensors, imu, odometry, battery, bias }
    }

    /// The IMU's body rates (rad/s) and specific force (m/s2). What is due at `time_s` goes into `log`, too.
    pub fn read(&mut self, time_s: f64, now: &Actual, log: &mut Log) -> [f64; 6] {
        let SensorConfig { imu, odometry, battery } = self.sensors;
        let [p, q, r] = imu.gyro.read(now.body_rates, self.bias.gyro, &mut self.imu);
        let [x, y, z] = imu.specific_force.read(now.specific_force, self.bias.specific_force, &mut self.imu);
        let sample = [p, q, r, x, y, z];
        if due(&log.imu, imu.rate_hz, time_s) {
            log.imu.push(time_s, sample);
        }
        if due(&log.odometry, odometry.rate_hz, time_s) {
            let [x, y, z] = odometry.position.read(now.position, self.bias.position, &mut self.odometry);
            let turn = odometry.attitude.channel().read([0.0; 3], self.bias.attitude, &mut self.odometry);
            let [qw, qx, qy, qz] = normalized(compose(now.attitude, small_rotation(turn, 1.0)));
            let body = body_axes(now.attitude).map(|axis| dot(axis, now.velocity));
            let [u, v, w] = odometry.velocity.read(body, self.bias.velocity, &mut self.odometry);
            log.odometry.push(time_s, [x, y, z, qw, qx, qy, qz, u, v, w]);
        }
        if due(&log.battery, battery.rate_hz, time_s) {
            let [voltage] = battery.voltage.read([now.voltage], self.bias.voltage, &mut self.battery);
            log.battery.push(time_s, [voltage, f64::NAN]);
        }
        sample
    }
}

/// Whether the next sample of a stream is due, at the latest by a millionth of its period.
pub fn due<const N: usize>(stream: &Stream<N>, rate_hz: f64, time_s: f64) -> bool {
    stream.len() as f64 <= time_s * rate_hz + 1e-6
}
