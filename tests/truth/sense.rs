//! Sensors: own rates and phases, noise, bias, range and resolution.

use super::integrate::specific_force;
use super::{State, Vehicle};
use nalgebra::{UnitQuaternion, Vector3};
use racer::flight::Log;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;

/// White noise of body rates, rad/s, and the sd of their constant error.
const GYRO: [f64; 2] = [0.03, 0.01];
/// White noise of specific force without throttle, m/s2 (twice that at full), and the sd of its constant error.
const ACCELEROMETER: [f64; 2] = [0.3, 0.07];
/// Noise of position (m), attitude (rad), velocity (m/s).
const ODOMETRY: [f64; 3] = [0.02, 0.003, 0.03];
/// Noise and resolution of the voltage, V.
const VOLTAGE: [f64; 2] = [0.02, 0.01];
/// Largest rate (rad/s) and specific force (m/s2) that 16 bits stand for.
const GYRO_RANGE: f64 = 2000.0 * std::f64::consts::PI / 180.0;
const FORCE_RANGE: f64 = 16.0 * 9.80665;

/// When a stream is next due.
struct Clock {
    next: f64,
    period: f64,
}

impl Clock {
    fn new(rate: f64, rng: &mut StdRng) -> Self {
        let period = 1.0 / rate;
        Clock { next: rng.random_range(0.0..period), period }
    }

    /// The time due before `end`, if any.
    fn due(&mut self, end: f64) -> Option<f64> {
        let now = self.next;
        (now < end).then(|| {
            self.next += self.period;
            now
        })
    }
}

/// All sensors of a vehicle.
pub struct Sensors {
    rng: StdRng,
    scale: f64,
    gyro_bias: Vector3<f64>,
    force_bias: Vector3<f64>,
    imu: Clock,
    odometry: Clock,
    battery: Clock,
}

impl Sensors {
    /// Draws rates, phases and constant errors; `scale` multiplies all errors, and none leaves out quantisation as
    /// well.
    pub fn new(seed: u64, scale: f64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed ^ 0x5e4505);
        let (odometry, battery) = (rng.random_range(100.0..200.0_f64), rng.random_range(10.0..50.0_f64));
        let mut sensors = Sensors {
            imu: Clock::new(500.0, &mut rng),
            odometry: Clock::new(odometry.round(), &mut rng),
            battery: Clock::new(battery.round(), &mut rng),
            gyro_bias: Vector3::zeros(),
            force_bias: Vector3::zeros(),
            rng,
            scale,
        };
        sensors.gyro_bias = sensors.normal(GYRO[1]);
        sensors.force_bias = sensors.normal(ACCELEROMETER[1]);
        sensors
    }

    /// Records what is due in the `dt` seconds from `time`; `at` says the state at a moment among them.
    pub fn sense(&mut self, time: f64, dt: f64, at: &dyn Fn(f64) -> State, vehicle: &Vehicle, log: &mut Log) {
        let end = time + dt;
        while let Some(due) = self.imu.due(end) {
            let row = self.imu_row(&at(due), vehicle);
            log.imu.push(due, row);
        }
        while let Some(due) = self.odometry.due(end) {
            let row = self.odometry_row(&at(due));
            log.odometry.push(due, row);
        }
        while let Some(due) = self.battery.due(end) {
            let voltage = at(due).voltage + self.normal(VOLTAGE[0]).x;
            log.battery.push(due, [self.rounded(voltage, VOLTAGE[1]), f64::NAN]);
        }
    }

    fn imu_row(&mut self, s: &State, vehicle: &Vehicle) -> [f64; 6] {
        let gyro = s.rates(vehicle) + self.gyro_bias + self.normal(GYRO[0]);
        let shaking = ACCELEROMETER[0] * (1.5 + 0.5 * s.response.w);
        let force = specific_force(s, vehicle) + self.force_bias + self.normal(shaking);
        let bits = |x: f64, range: f64| self.rounded(x, range / 32768.0).clamp(-range, range);
        let [gyro, force] = [gyro.map(|x| bits(x, GYRO_RANGE)), force.map(|x| bits(x, FORCE_RANGE))];
        [gyro.x, gyro.y, gyro.z, force.x, force.y, force.z]
    }

    fn odometry_row(&mut self, s: &State) -> [f64; 10] {
        let p = s.position + self.normal(ODOMETRY[0]);
        let q = s.rotation() * UnitQuaternion::from_scaled_axis(self.normal(ODOMETRY[1]));
        let v = s.body_velocity() + self.normal(ODOMETRY[2]);
        [p.x, p.y, p.z, q.w, q.i, q.j, q.k, v.x, v.y, v.z]
    }

    fn normal(&mut self, sd: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.scale * sd * self.rng.sample::<f64, _>(StandardNormal))
    }

    fn rounded(&self, x: f64, step: f64) -> f64 {
        if self.scale == 0.0 { x } else { (x / step).round() * step }
    }
}
