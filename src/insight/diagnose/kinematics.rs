//! What the IMU alone says of a flight: what it integrates to between two looks of the odometry.

use super::model::Model;
use super::record::FlightRecord;
use crate::base::lane::build;
use crate::model::attitude::{Quaternion, body_axes, compose, in_world, normalized, rotation_vector, small_rotation};
use crate::model::dynamics::extended;
use crate::model::effects::{self, Role, Sensed};

/// What the IMU, corrected, integrates to over each window: the turn (rotation vector) and the change of velocity (less
/// gravity), both in the body frame at the window's beginning.
#[inline(always)]
pub fn integrate(model: &Model, record: &FlightRecord, x: &[f64], command: &[[f64; 4]]) -> [Vec<f64>; 6] {
    let mut out: [Vec<f64>; 6] = Default::default();
    if record.windows.is_empty() {
        return out;
    }
    let k = model.sensors(x);
    // A gyro that is late was not what the odometry's clock was to be moved to.
    let late = model.acting(x, Role::GyroLate);
    let moved = if late == 0.0 { 0.0 } else { record.moved };
    let offset = late - moved;
    let stretch = 1.0 / (1.0 + model.acting(x, Role::ClockFast));
    let tau = model.acting(x, Role::VelocityLag);
    let odometry = model.acting(x, Role::OdometryLate);
    let gyro = shifted(record, 0, offset - odometry);
    let force = shifted(record, 3, -moved - odometry);
    let fine = &record.fine;
    let slope = slopes(&fine.time, &gyro);
    let mut corrected: Vec<[f64; 6]> = Vec::with_capacity(gyro.len());
    for i in 0..gyro.len() {
        let throttle = extended::throttle(command[i / fine.every][3]);
        let throttle = if throttle.is_finite() { throttle } else { 0.0 };
        corrected.push(truth(k, [gyro[i], force[i]], slope[i], throttle));
    }
    let lagged = if tau > 0.0 { Some(missing(record, &corrected, tau)) } else { None };
    for &[from, to] in &record.windows {
        let mut turn: Quaternion<f64> = [1.0, 0.0, 0.0, 0.0];
        let axes = record.axes[from];
        // Gravity was taken off the measured change for as long as the recorder's clock said, not for as long as it
        // was.
        let fast = (1.0 - stretch) * (record.time[to] - record.time[from]) * model.vehicle().gravity_m_s2;
        let mut pushed: [f64; 3] = std::array::from_fn(|j| fast * axes[j][2]);
        for i in from * fine.every..to * fine.every {
            let h = (fine.time[i + 1] - fine.time[i]) * stretch;
            let mean: [f64; 6] = std::array::from_fn(|j| 0.5 * (corrected[i][j] + corrected[i + 1][j]));
            let half = small_rotation([mean[0], mean[1], mean[2]], 0.5 * h);
            let middle = compose(turn, half);
            turn = normalized(compose(middle, half));
            let mut push = in_world(&body_axes(middle), [mean[3], mean[4], mean[5]]);
            if let Some(world) = &lagged {
                for j in 0..3 {
                    push[j] += (0..3).map(|c| axes[j][c] * 0.5 * (world[i][c] + world[i + 1][c])).sum::<f64>();
                }
            }
            (0..3).for_each(|j| pushed[j] += h * push[j]);
        }
        let rotated = rotation_vector(turn);
        for j in 0..3 {
            out[j].push(rotated[j]);
            if record.moves {
                out[3 + j].push(pushed[j]);
            }
        }
    }
    out
}

/// The truth behind a reading of rates and specific force: what the sensors make of it is small, so that two rounds of
/// correction are enough.
#[inline(always)]
fn truth(k: &[f64], measured: [[f64; 3]; 2], acceleration: [f64; 3], throttle: f64) -> [f64; 6] {
    let [mut rates, mut force] = measured;
    for _ in 0..2 {
        let mut sensed = Sensed { rates, acceleration, force, throttle };
        effects::sense(k, &mut sensed);
        rates = std::array::from_fn(|j| rates[j] + measured[0][j] - sensed.rates[j]);
        force = std::array::from_fn(|j| force[j] + measured[1][j] - sensed.force[j]);
    }
    [rates[0], rates[1], rates[2], force[0], force[1], force[2]]
}

/// Three measured values from the `from`th on, as they were when samples that are `offset` seconds late say they are.
#[inline(always)]
fn shifted(record: &FlightRecord, from: usize, offset: f64) -> Vec<[f64; 3]> {
    let n = record.fine.time.len();
    if offset == 0.0 {
        return (0..n).map(|i| std::array::from_fn(|k| record.fine.imu[from + k][i])).collect();
    }
    let at = |t: f64, k: usize, near: usize| {
        let mut i = near.min(n - 2);
        while i > 0 && record.fine.time[i] > t {
            i -= 1;
        }
        while i + 2 < n && record.fine.time[i + 1] < t {
            i += 1;
        }
        let share = ((t - record.fine.time[i]) / (record.fine.time[i + 1] - record.fine.time[i])).clamp(0.0, 1.0);
        record.fine.imu[k][i] + share * (record.fine.imu[k][i + 1] - record.fine.imu[k][i])
    };
    (0..n).map(|i| std::array::from_fn(|k| at(record.fine.time[i] + offset, from + k, i))).collect()
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

/// What such a lag adds to the corrected specific forces.
#[inline(always)]
fn missing(record: &FlightRecord, corrected: &[[f64; 6]], tau: f64) -> Vec<[f64; 3]> {
    let force = |i: usize| -> [f64; 3] { build!(|k| corrected[i][3 + k]) };
    let late = lagged(record, tau, force);
    let added = |i: usize| {
        let world = in_world(&fine_axes(record, i), force(i));
        let added: [f64; 3] = build!(|k| late[i][k] - world[k]);
        if added[0].is_finite() { added } else { [0.0; 3] }
    };
    (0..late.len()).map(added).collect()
}

/// The body's axes in the world at a sample of the whole IMU, between those at the record's.
#[inline(always)]
fn fine_axes(record: &FlightRecord, i: usize) -> [[f64; 3]; 3] {
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
