//! Sensors with what may be wrong with them: own rates and phases, noise, bias, range, resolution, place, clock.

use super::motion::{self, Inputs};
use super::{Craft, Setting, World, air, battery, inner, thrust};
use nalgebra::{UnitQuaternion, Vector3};
use racer::flight::Log;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use std::collections::VecDeque;

/// White noise of body rates, rad/s, and the sd of their constant error.
const GYRO: [f64; 2] = [0.03, 0.002];
/// White noise of specific force without throttle, m/s2 (twice that at full), and the sd of its constant error.
const ACCELEROMETER: [f64; 2] = [0.3, 0.01];
/// Noise of position (m), attitude (rad), velocity (m/s).
const ODOMETRY: [f64; 3] = [0.02, 0.003, 0.03];
/// Noise and resolution of the voltage, V.
const VOLTAGE: [f64; 2] = [0.02, 0.01];
/// How much more the gyro shakes in its own downwash, times.
const WASH: f64 = 3.0;
/// Share of the rectified vibration that is felt along x.
const RECTIFIED_X: f64 = 0.3;
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
    /// The gyro is read earlier than it says, the accelerometer when it says.
    gyro: Clock,
    imu: Clock,
    odometry: Clock,
    battery: Clock,
    /// Body rates that are read and not logged yet.
    read: VecDeque<Vector3<f64>>,
}

impl Sensors {
    pub fn new(setting: &Setting, world: &World) -> Self {
        let mut rng = StdRng::seed_from_u64(setting.seed ^ 0x5e4506);
        let [odometry, battery] = [rng.random_range(100.0..200.0_f64), rng.random_range(10.0..50.0_f64)];
        let imu = Clock::new(setting.imu_hz, &mut rng);
        let mut sensors = Sensors {
            gyro: Clock { next: imu.next - world.terms.gyro_offset, period: imu.period },
            imu,
            odometry: Clock::new(odometry.round(), &mut rng),
            battery: Clock::new(battery.round(), &mut rng),
            gyro_bias: Vector3::zeros(),
            force_bias: Vector3::zeros(),
            rng,
            scale: setting.noise,
            read: VecDeque::new(),
        };
        // A calibrated sensor, whatever its noise: larger constants are an effect of their own.
        let noise = setting.noise.max(1e-9);
        let calibrated = |v: Vector3<f64>, sd: f64| v.map(|x| (x / noise).clamp(-1.5 * sd, 1.5 * sd));
        let (gyro, force) = (sensors.normal(GYRO[1]), sensors.normal(ACCELEROMETER[1]));
        (sensors.gyro_bias, sensors.force_bias) = (calibrated(gyro, GYRO[1]), calibrated(force, ACCELEROMETER[1]));
        // A hidden bias is all there is, or its truth would not be known.
        if world.terms.gyro_bias != Vector3::zeros() {
            sensors.gyro_bias = Vector3::zeros();
        }
        if world.terms.accel_bias != Vector3::zeros() {
            sensors.force_bias = Vector3::zeros();
        }
        sensors
    }

    /// Records what is due in the `dt` seconds from `time`; `at` says the state at a moment among them.
    pub fn sense(
        &mut self,
        time: f64,
        dt: f64,
        at: &dyn Fn(f64) -> Craft,
        inputs: &Inputs,
        world: &World,
        log: &mut Log,
    ) {
        let end = time + dt;
        // All but the setpoints are stamped by this clock.
        let stamp = |due: f64| due * (1.0 + world.terms.skew);
        while let Some(due) = self.gyro.due(end) {
            let rates = self.rates(&at(due.max(time)), inputs, world, due.max(0.0));
            self.read.push_back(rates);
        }
        while let Some(due) = self.imu.due(end) {
            let craft = at(due);
            let force = self.force(&craft, inputs, world, due);
            let rates = self.read.pop_front().unwrap_or_else(Vector3::zeros);
            log.imu.push(stamp(due), [rates.x, rates.y, rates.z, force.x, force.y, force.z]);
        }
        while let Some(due) = self.odometry.due(end) {
            let row = self.odometry_row(&at(due), world);
            log.odometry.push(stamp(due), row);
        }
        while let Some(due) = self.battery.due(end) {
            let voltage = battery::terminal(&at(due), world, due) + self.normal(VOLTAGE[0]).x;
            log.battery.push(stamp(due), [self.rounded(voltage, VOLTAGE[1]), f64::NAN]);
        }
    }

    fn rates(&mut self, craft: &Craft, inputs: &Inputs, world: &World, time: f64) -> Vector3<f64> {
        let terms = &world.terms;
        let v = air::velocity(craft, world, &inputs.air.velocity);
        let shaking = GYRO[0] * (1.0 + WASH * thrust::washed(craft, world, &v, time));
        let turned = UnitQuaternion::from_scaled_axis(terms.misalignment) * inner::body_rates(craft, terms);
        let measured = turned * (1.0 + terms.gyro_scale) + terms.gyro_bias;
        (measured + self.gyro_bias + self.normal(shaking)).map(|x| self.bits(x, GYRO_RANGE))
    }

    fn force(&mut self, craft: &Craft, inputs: &Inputs, world: &World, time: f64) -> Vector3<f64> {
        let terms = &world.terms;
        let command = inputs.link.at(time);
        let mut force = motion::specific_force(craft, world, inputs, command, time);
        if terms.lever != Vector3::zeros() {
            let w = inner::body_rates(craft, terms);
            let change = motion::slope(craft, world, inputs, command, time);
            let faster = inner::body_acceleration(craft, &change, terms);
            force += faster.cross(&terms.lever) + w.cross(&w.cross(&terms.lever));
        }
        let turned = [terms.accel_misalignment, terms.misalignment].map(UnitQuaternion::from_scaled_axis);
        force = turned[1] * (turned[0] * force) * (1.0 + terms.accel_scale);
        let shaken = terms.rectification * craft.share().powi(2);
        force += terms.accel_bias + Vector3::new(RECTIFIED_X * shaken, 0.0, shaken);
        let shaking = ACCELEROMETER[0] * (1.5 + 0.5 * craft.u);
        (force + self.force_bias + self.normal(shaking)).map(|x| self.bits(x, FORCE_RANGE))
    }

    fn odometry_row(&mut self, craft: &Craft, world: &World) -> [f64; 10] {
        let lags = world.terms.velocity_lag > 0.0 || world.terms.estimator > 0.0;
        let velocity = if lags { craft.estimate } else { craft.velocity };
        let p = craft.position + self.normal(ODOMETRY[0]);
        let q = craft.rotation() * UnitQuaternion::from_scaled_axis(self.normal(ODOMETRY[1]));
        let v = craft.rotation().inverse() * velocity + self.normal(ODOMETRY[2]);
        [p.x, p.y, p.z, q.w, q.i, q.j, q.k, v.x, v.y, v.z]
    }

    fn normal(&mut self, sd: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.scale * sd * self.rng.sample::<f64, _>(StandardNormal))
    }

    fn bits(&self, x: f64, range: f64) -> f64 {
        self.rounded(x, range / 32768.0).clamp(-range, range)
    }

    fn rounded(&self, x: f64, step: f64) -> f64 {
        if self.scale == 0.0 { x } else { (x / step).round() * step }
    }
}
