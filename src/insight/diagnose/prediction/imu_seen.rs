//! The IMU's samples at other times than their own: on the odometry's clock, and as a velocity that lags sees them.

use super::record::FlightRecord;
use crate::base::lane::build;
use crate::model::attitude::in_world;
use std::sync::Arc;

/// The IMU's samples on the odometry's clock.
#[derive(Debug, Default)]
pub struct ShiftedImu {
    /// By how much the gyro and the accelerometer are late, s; none before there are any samples.
    offsets: Option<[f64; 2]>,
    /// Body rates (rad/s), how fast they change (rad/s2), and specific force (m/s2).
    pub gyro: Vec<[f64; 3]>,
    pub slope: Vec<[f64; 3]>,
    pub force: Vec<[f64; 3]>,
}

impl ShiftedImu {
    /// `known`, where it is of the same `offsets`: it costs as much as all that is integrated with it.
    pub fn renewed(known: Arc<Self>, record: &FlightRecord, offsets: [f64; 2]) -> Arc<Self> {
        if known.offsets == Some(offsets) {
            return known;
        }
        let (gyro, force) = (shifted(record, 0, offsets[0]), shifted(record, 3, offsets[1]));
        let slope = slopes(&record.fine.time, &gyro);
        Self { offsets: Some(offsets), gyro, slope, force }.into()
    }
}

/// The measured specific force in the world, through a first-order lag.
#[derive(Debug, Default)]
pub struct LaggedForce {
    /// Time constant, s; 0 before there are any samples.
    tau: f64,
    /// At every sample of the whole IMU, m/s2.
    pub world: Vec<[f64; 3]>,
}

impl LaggedForce {
    /// `known`, where it is of the same time constant `tau` above 0.
    pub fn renewed(known: Arc<Self>, record: &FlightRecord, tau: f64) -> Arc<Self> {
        if known.tau == tau {
            return known;
        }
        let force = |i: usize| -> [f64; 3] { build!(|k| record.fine.imu[3 + k][i]) };
        Self { tau, world: lagged(record, tau, force) }.into()
    }
}

/// Three measured values from the `from`th on, as they were when samples that are `offset` seconds late say they are.
#[inline(always)]
fn shifted(record: &FlightRecord, from: usize, offset: f64) -> Vec<[f64; 3]> {
    let n = record.fine.time.len();
    if offset == 0.0 {
        return (0..n).map(|i| std::array::from_fn(|k| record.fine.imu[from + k][i])).collect();
    }
    let (time, imu) = (&record.fine.time, &record.fine.imu[from..from + 3]);
    let one = |near: usize| -> [f64; 3] {
        let t = time[near] + offset;
        let mut i = near.min(n - 2);
        while i > 0 && time[i] > t {
            i -= 1;
        }
        while i + 2 < n && time[i + 1] < t {
            i += 1;
        }
        let share = ((t - time[i]) / (time[i + 1] - time[i])).clamp(0.0, 1.0);
        build!(|k| imu[k][i] + share * (imu[k][i + 1] - imu[k][i]))
    };
    (0..n).map(one).collect()
}

/// Specific forces `force` of the IMU's samples, turned into the world and through a first-order lag of `tau` seconds;
/// straight lines between samples.
#[inline(always)]
pub fn lagged(record: &FlightRecord, tau: f64, force: impl Fn(usize) -> [f64; 3]) -> Vec<[f64; 3]> {
    let fine = &record.fine;
    let mut now: Option<[[f64; 3]; 2]> = None;
    let mut out = Vec::with_capacity(fine.time.len());
    for i in 0..fine.time.len() {
        let world = in_world(&fine_axes(record, i), force(i));
        let finite = world[0].is_finite() && world[1].is_finite() && world[2].is_finite();
        let next = match now {
            Some([late, _]) if !finite => late,
            Some([late, before]) => {
                let h = fine.time[i] - fine.time[i - 1];
                let alpha = crate::model::dynamics::response::alpha(tau, h);
                build!(|k| {
                    let rising = (world[k] - before[k]) * tau / h.max(1e-9);
                    world[k] - rising * alpha + (late[k] - before[k]) * (1.0 - alpha)
                })
            }
            None => world,
        };
        if finite {
            now = Some([next, world]);
        }
        out.push(if next[0].is_finite() { next } else { [0.0; 3] });
    }
    out
}

/// The body's axes in the world at a sample of the whole IMU, between those at the record's.
#[inline(always)]
pub fn fine_axes(record: &FlightRecord, i: usize) -> [[f64; 3]; 3] {
    let at = i / record.fine.every;
    let share = (i % record.fine.every) as f64 / record.fine.every as f64;
    let (a, b) = (&record.axes[at], &record.axes[(at + 1).min(record.axes.len() - 1)]);
    build!(|j| build!(|k| a[j][k] + share * (b[j][k] - a[j][k])))
}

/// Change of each rate, by central differences.
#[inline(always)]
pub fn slopes(time: &[f64], rates: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let n = time.len();
    let one = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(n - 1));
        let h = (time[b] - time[a]).max(1e-6);
        std::array::from_fn(|k| (rates[b][k] - rates[a][k]) / h)
    };
    (0..n).map(one).collect()
}
