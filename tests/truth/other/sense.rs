//! The recorder: an IMU, an estimator whose errors last for seconds, clocks, and packets that are lost.

use super::airframe::Airframe;
use super::faults::Faults;
use super::plant::Plant;
use crate::truth::hidden::Setting;
use nalgebra::{UnitQuaternion, Vector3};
use racer::flight::Log;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use std::collections::VecDeque;

/// Noise of the gyro (rad/s) and the accelerometer (m/s2, times the mean speed of the motors besides).
const GYRO: f64 = 0.03;
const ACCELEROMETER: f64 = 0.35;
/// Share of the packets that is lost, and time between the gaps of all sensors, s.
const LOST: f64 = 0.01;
const GAP_EVERY_S: f64 = 9.0;

/// A random error with a memory.
#[derive(Clone, Debug)]
struct Wander {
    size: f64,
    memory_s: f64,
    now: Vector3<f64>,
}

impl Wander {
    fn new(size: f64, memory_s: f64) -> Self {
        Wander { size, memory_s, now: Vector3::zeros() }
    }

    fn next(&mut self, dt: f64, any: Vector3<f64>) -> Vector3<f64> {
        let keep = (-dt / self.memory_s).exp();
        self.now = self.now * keep + any * (self.size * (1.0 - keep * keep).sqrt());
        self.now
    }
}

/// See the module.
pub struct Recorder {
    rng: StdRng,
    noise: f64,
    /// Periods of IMU, odometry and battery, s, and when each is next due.
    period: [f64; 3],
    due: [f64; 3],
    /// Odometry is stamped so much late, s.
    late: f64,
    velocity: [Wander; 2],
    attitude: Wander,
    position: Wander,
    gap: [f64; 2],
    /// What was measured and is not stamped yet, and filters of what the sensors say.
    waiting: VecDeque<(f64, [f64; 6])>,
    gyro: [Vector3<f64>; 2],
    lever: Vector3<f64>,
    observed: [Vector3<f64>; 2],
    past: VecDeque<(f64, Vector3<f64>)>,
}

impl Recorder {
    pub fn new(setting: &Setting) -> Self {
        let mut rng = StdRng::seed_from_u64(setting.seed ^ 0x0b5e);
        let odometry = 1.0 / rng.random_range(100.0..200.0_f64).round();
        let battery = 1.0 / rng.random_range(10.0..40.0_f64).round();
        let (noise, zero) = (setting.noise, Vector3::zeros());
        Recorder {
            noise,
            period: [1.0 / setting.imu_hz, odometry, battery],
            due: [0.0, 0.003, 0.01],
            late: rng.random_range(0.0..0.01),
            velocity: [Wander::new(0.03 * noise, 0.4), Wander::new(0.05 * noise, 5.0)],
            attitude: Wander::new(0.004 * noise, 3.0),
            position: Wander::new(0.05 * noise, 8.0),
            gap: [rng.random_range(2.0..GAP_EVERY_S), 0.06],
            waiting: VecDeque::new(),
            gyro: [zero; 2],
            lever: zero,
            observed: [zero; 2],
            past: VecDeque::new(),
            rng,
        }
    }

    /// Records what is due by `time`.
    pub fn sense(&mut self, plant: &Plant, airframe: &Airframe, faults: &Faults, time: f64, log: &mut Log) {
        self.filter(plant, faults, time);
        if time > self.gap[0] + self.gap[1] {
            self.gap = [time + self.rng.random_range(0.5..1.5) * GAP_EVERY_S, self.rng.random_range(0.02..0.1)];
        }
        let gone = (self.gap[0]..self.gap[0] + self.gap[1]).contains(&time);
        let is_due = std::array::from_fn::<bool, 3, _>(|k| time >= self.due[k]);
        (0..3).filter(|&k| is_due[k]).for_each(|k| self.due[k] += self.period[k]);
        let bend = faults.of("clock_bend");
        // The sensors' clock gains, more and more.
        let stamp = |t: f64| t + bend * (t + t * t / faults.seconds);
        if is_due[0] {
            let row = self.imu(plant, airframe, faults, time);
            self.waiting.push_back((time, row));
        }
        while self.waiting.front().is_some_and(|(t, _)| *t + faults.of("imu_late") <= time) {
            let Some((_, row)) = self.waiting.pop_front() else { break };
            if !gone && self.rng.random::<f64>() > LOST {
                log.imu.push(stamp(time), row);
            }
        }
        if is_due[0] && !gone {
            // Speeds that the controllers of the motors are asked for.
            log.motors.push(stamp(time), racer::flight::motors::row(plant.shares.map(f64::sqrt).as_slice()));
        }
        if is_due[1] {
            let row = self.odometry(plant, faults);
            if !gone && self.rng.random::<f64>() > LOST {
                let jitter = 2e-4 * self.rng.random_range(-1.0..1.0);
                log.odometry.push(stamp(time) + self.late + jitter, row);
            }
        }
        if is_due[2] && !gone {
            let volts = plant.pack.volts + 0.02 * self.noise * self.rng.sample::<f64, _>(StandardNormal);
            log.battery.push(stamp(time), [(volts * 100.0).round() / 100.0, f64::NAN]);
        }
    }

    /// What goes on between samples.
    fn filter(&mut self, plant: &Plant, faults: &Faults, time: f64) {
        let dt = super::STEP_S;
        let tau = faults.of("gyro_filter");
        let keep = if tau > 0.0 { (-dt / tau).exp() } else { 0.0 };
        self.gyro[0] = self.gyro[0] * keep + plant.rates * (1.0 - keep);
        self.gyro[1] = self.gyro[1] * keep + self.gyro[0] * (1.0 - keep);
        let r = faults.along * faults.of("lever_soft");
        let w = plant.rates;
        let pulled = plant.turning.cross(&r) + w.cross(&w.cross(&r));
        // The mount lets 30 Hz through.
        self.lever += (pulled - self.lever) * (1.0 - (-dt * 188.0_f64).exp());
        let lag = faults.of("velocity_observer");
        if lag > 0.0 {
            // Second order without overshoot, of this mean delay.
            let error = plant.velocity - self.observed[0];
            let rate = 2.0 / lag;
            self.observed[1] += (error * (rate * rate) - self.observed[1] * (2.0 * rate)) * dt;
            self.observed[0] += self.observed[1] * dt;
        }
        if faults.has("velocity_delay") {
            self.past.push_back((time, plant.velocity));
            while self.past.len() > 2 && self.past[1].0 <= time - faults.of("velocity_delay") {
                self.past.pop_front();
            }
        }
    }

    fn imu(&mut self, plant: &Plant, airframe: &Airframe, faults: &Faults, time: f64) -> [f64; 6] {
        let warm = 1.0 - (-time / 25.0).exp();
        let tilt = UnitQuaternion::from_scaled_axis(faults.along * faults.of("imu_tilt"));
        let other = UnitQuaternion::from_scaled_axis(faults.along * faults.of("accel_tilt"));
        let axis = faults.which % 3;
        let mut rates = tilt * self.gyro[1] + faults.along * (faults.of("gyro_warm") * warm);
        rates[axis] *= 1.0 + faults.of("gyro_axis");
        let speed = plant.speeds.mean();
        let mut force = tilt * other * (plant.force + self.lever);
        force[axis] *= 1.0 + faults.of("accel_axis");
        force += faults.along * (faults.of("accel_warm") * warm);
        let hover = (airframe.mass * 9.80665 / airframe.full_n).sqrt();
        let bell = (-((speed / hover - 1.3) / 0.25).powi(2)).exp();
        force.z += faults.of("vibration_speed") * speed.powi(4) + faults.of("vibration_bell") * bell;
        rates += self.normal() * (GYRO * self.noise);
        force += self.normal() * (ACCELEROMETER * self.noise * (0.5 + speed));
        let round = |x: f64, step: f64| (x / step).round() * step;
        std::array::from_fn(|k| if k < 3 { round(rates[k], 0.001) } else { round(force[k - 3], 0.005) })
    }

    fn odometry(&mut self, plant: &Plant, faults: &Faults) -> [f64; 10] {
        let dt = self.period[1];
        let mut velocity = plant.velocity;
        if faults.has("velocity_observer") {
            velocity = self.observed[0];
        }
        if let Some((_, before)) = self.past.front() {
            velocity = *before;
        }
        for k in 0..2 {
            let any = self.normal();
            velocity += self.velocity[k].next(dt, any);
        }
        let (turn, place) = (self.normal(), self.normal());
        let q = plant.attitude * UnitQuaternion::from_scaled_axis(self.attitude.next(dt, turn));
        let v = q.inverse() * velocity;
        let p = plant.position + self.position.next(dt, place);
        [p.x, p.y, p.z, q.w, q.i, q.j, q.k, v.x, v.y, v.z]
    }

    fn normal(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.rng.sample::<f64, _>(StandardNormal))
    }
}
