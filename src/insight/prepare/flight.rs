//! A checked log on one clock, that of the IMU.

use super::attitude::attitude;
use super::lag::{Following, followed};
use crate::flight::Stream;
use crate::flight::lowpass::LowPass;
use crate::flight::series::{held, interpolated, period};
use crate::flight::spans::contain;
use crate::insight::quality::Quality;
use crate::model::attitude::Quaternion;

/// Odometry is not interpolated across more than this, s.
const REACH_S: f64 = 0.25;
/// Cut-off of the voltage, Hz: sag stays, noise goes.
const VOLTAGE_HZ: f64 = 5.0;

/// One flight, ready to fit.
#[derive(Clone, Debug)]
pub struct PreparedFlight {
    pub quality: Quality,
    /// Times of the IMU, s.
    pub time: Vec<f64>,
    /// Which of them are usable flight.
    pub usable: Vec<bool>,
    /// Voltage (V), body velocity (m/s), attitude (body to world) and position (m) at these times; NaN where unknown.
    pub voltage: Vec<f64>,
    pub velocity: [Vec<f64>; 3],
    pub attitude: Vec<Quaternion<f64>>,
    pub position: [Vec<f64>; 3],
    /// Stretch of time that each sample belongs to, counted over all flights.
    pub block: Vec<u32>,
}

impl PreparedFlight {
    /// `first_block` is the number of its first stretch, `block_s` their length.
    pub fn new(quality: Quality, first_block: u32, block_s: f64) -> Self {
        let log = &quality.log;
        let time = log.imu.time_s.clone();
        let start = time.first().copied().unwrap_or(0.0);
        let usable = time.iter().map(|&t| contain(&quality.usable, t)).collect();
        let odometry = |k: usize| interpolated(&log.odometry.time_s, &log.odometry.column(k), &time, REACH_S);
        let (position, velocity) = (std::array::from_fn(odometry), std::array::from_fn(|k| odometry(7 + k)));
        let attitude = attitude(&log.odometry, &time);
        let block = time.iter().map(|t| first_block + ((t - start) / block_s) as u32).collect();
        let voltage = voltage(&log.battery, &time);
        Self { voltage, velocity, attitude, position, usable, block, time, quality }
    }

    /// What command `k` of the setpoints has become at each sample, as `by` follows it. Commands are held until the
    /// next, and the response is integrated exactly.
    pub fn response(&self, k: usize, by: Following) -> Vec<f64> {
        let setpoint = &self.quality.log.setpoint;
        followed(&setpoint.time_s, &setpoint.column(k), &self.time, by)
    }

    /// Number `k` of the IMU.
    pub fn measured(&self, k: usize) -> Vec<f64> {
        self.quality.log.imu.column(k)
    }

    /// Removes what lies above `cutoff_hz`, without delay, between the places where `x` is unknown or time has gaps.
    pub fn smooth(&self, mut x: Vec<f64>, cutoff_hz: f64) -> Vec<f64> {
        let dt = period(&self.time);
        let Some(filter) = LowPass::new(cutoff_hz, dt) else { return x };
        let mut from = 0;
        while from < x.len() {
            if !x[from].is_finite() {
                from += 1;
                continue;
            }
            let broken = |i: usize| !x[i].is_finite() || self.time[i] - self.time[i - 1] > 5.0 * dt;
            let to = (from + 1..x.len()).find(|&i| broken(i)).unwrap_or(x.len());
            filter.run(&mut x[from..to]);
            from = to;
        }
        x
    }
}

/// Voltage at `times`, smoothed where it was measured often enough; constant beyond the first and the last sample.
fn voltage(battery: &Stream<2>, times: &[f64]) -> Vec<f64> {
    let (t, v): (Vec<f64>, Vec<f64>) =
        battery.time_s.iter().zip(&battery.rows).map(|(t, row)| (*t, row[0])).filter(|(_, v)| *v > 0.0).unzip();
    let (Some(&first), Some(&last)) = (t.first(), t.last()) else { return vec![f64::NAN; times.len()] };
    let mut smooth = v.clone();
    if let Some(filter) = LowPass::new(VOLTAGE_HZ, period(&t)) {
        filter.run(&mut smooth);
    }
    let inside: Vec<f64> = times.iter().map(|time| time.clamp(first, last)).collect();
    let line = interpolated(&t, &smooth, &inside, 5.0);
    if line.iter().any(|v| v.is_nan()) { held(&t, &smooth, &inside) } else { line }
}
