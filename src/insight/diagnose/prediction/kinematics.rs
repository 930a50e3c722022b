//! What the IMU alone says of a flight: what it integrates to between two looks of the odometry.

use super::bends;
use super::imu_seen::{ShiftedImu, fine_axes, lagged};
use super::model::Model;
use super::record::FlightRecord;
use crate::base::lane::{build, fused};
use crate::model::attitude::{Quaternion, body_axes, compose, in_world, normalized, small_rotation};
use crate::model::dynamics::extended;
use crate::model::effects::{Role, Sensed, SensorErrors};
use rayon::prelude::*;

/// Windows that one thread integrates while others integrate others.
const SIDE_BY_SIDE: usize = 64;

/// By how much the gyro's and the accelerometer's samples are late to the attitude's and the velocity's, s.
pub fn offsets(model: &Model, record: &FlightRecord, x: &[f64]) -> [f64; 2] {
    // A gyro that is late was not what the odometry's clock was to be moved to.
    let late = model.acting(x, Role::GyroLate);
    let moved = if late == 0.0 { 0.0 } else { record.moved };
    let odometry = model.acting(x, Role::OdometryLate);
    let delay = model.acting(x, Role::VelocityLag) * x[bends::VELOCITY];
    [late - moved - odometry, -moved - odometry - delay]
}

/// What the IMU, corrected, integrates to over each window: the turn (rotation vector) and the change of velocity (less
/// gravity), both in the body frame at the window's beginning.
#[inline(always)]
pub fn integrate(
    model: &Model,
    record: &FlightRecord,
    x: &[f64],
    command: &[[f64; 4]],
    imu: &ShiftedImu,
) -> [Vec<f64>; 6] {
    let mut out: [Vec<f64>; 6] = Default::default();
    if record.windows.is_empty() {
        return out;
    }
    let stretch = 1.0 / (1.0 + model.acting(x, Role::ClockFast));
    let tau = model.acting(x, Role::VelocityLag) * (1.0 - x[bends::VELOCITY]);
    let corrected = corrected(&model.sensors(x).integrated(), record, command, imu);
    let lagged = if tau > 0.0 { Some(missing(record, &corrected, tau)) } else { None };
    let gravity = model.vehicle().gravity_m_s2;
    let fused_one = |window: &[usize; 2]| {
        fused(
            #[inline(always)]
            || over(window, record, [stretch, gravity], &corrected, lagged.as_deref()),
        )
    };
    let each: Vec<[f64; 6]> = record.windows.par_iter().with_min_len(SIDE_BY_SIDE).map(fused_one).collect();
    let seen = if record.moves { 6 } else { 3 };
    (0..seen).for_each(|j| out[j] = each.iter().map(|window| window[j]).collect());
    out
}

/// The same over one window, whose seconds are in truth `stretch` long. Inline, so that all of it is compiled for a
/// processor with a fused multiply-add.
#[inline(always)]
fn over(
    &[from, to]: &[usize; 2],
    record: &FlightRecord,
    [stretch, gravity]: [f64; 2],
    corrected: &[[f64; 6]],
    lagged: Option<&[[f64; 3]]>,
) -> [f64; 6] {
    let fine = &record.fine;
    let mut turn: Quaternion<f64> = [1.0, 0.0, 0.0, 0.0];
    let axes = record.axes[from];
    // Gravity was taken off the measured change for as long as the recorder's clock said, not for as long as it was.
    let fast = (1.0 - stretch) * (record.time[to] - record.time[from]) * gravity;
    let mut pushed: [f64; 3] = build!(|j| fast * axes[j][2]);
    for i in from * fine.every..to * fine.every {
        let h = (fine.time[i + 1] - fine.time[i]) * stretch;
        let mean: [f64; 6] = build!(|j| 0.5 * (corrected[i][j] + corrected[i + 1][j]));
        let half = small_rotation([mean[0], mean[1], mean[2]], 0.5 * h);
        let middle = compose(turn, half);
        turn = normalized(compose(middle, half));
        let mut push = in_world(&body_axes(middle), [mean[3], mean[4], mean[5]]);
        if let Some(world) = lagged {
            for j in 0..3 {
                push[j] += (0..3).map(|c| axes[j][c] * 0.5 * (world[i][c] + world[i + 1][c])).sum::<f64>();
            }
        }
        (0..3).for_each(|j| pushed[j] += h * push[j]);
    }
    joined([record.turn(turn, &[from, to]), pushed])
}

/// The IMU's samples without what the sensors `k` make of them: rates and specific force.
#[inline(always)]
fn corrected(k: &SensorErrors, record: &FlightRecord, command: &[[f64; 4]], imu: &ShiftedImu) -> Vec<[f64; 6]> {
    let mut out = Vec::with_capacity(imu.gyro.len());
    for i in 0..imu.gyro.len() {
        let measured = [imu.gyro[i], imu.force[i]];
        out.push(if k.any() {
            let throttle = extended::throttle(command[i / record.fine.every][3]);
            let throttle = if throttle.is_finite() { throttle } else { 0.0 };
            truth(k, measured, imu.slope[i], throttle)
        } else {
            joined(measured)
        });
    }
    out
}

/// The truth behind a reading of rates and specific force: what the sensors make of it is small, so that two rounds of
/// correction are enough.
#[inline(always)]
fn truth(k: &SensorErrors, measured: [[f64; 3]; 2], acceleration: [f64; 3], throttle: f64) -> [f64; 6] {
    let [mut rates, mut force] = measured;
    for _ in 0..2 {
        let mut sensed = Sensed { rates, acceleration, force, throttle };
        k.sense(&mut sensed);
        rates = build!(|j| rates[j] + measured[0][j] - sensed.rates[j]);
        force = build!(|j| force[j] + measured[1][j] - sensed.force[j]);
    }
    joined([rates, force])
}

#[inline(always)]
fn joined([rates, force]: [[f64; 3]; 2]) -> [f64; 6] {
    [rates[0], rates[1], rates[2], force[0], force[1], force[2]]
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
