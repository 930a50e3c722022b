//! What a log says of its motors and rotors, and whether its thrust command is in truth one of them.

use crate::base::stats::median;
use crate::flight::series::period;
use crate::flight::spans::{Span, joined};
use crate::flight::{Log, MOTORS, Stream};
use crate::insight::criteria::consistent::{ROTOR_COMMAND_ROWS, ROTOR_COMMAND_SHARE};
use crate::insight::criteria::identified::{MIXER_SETTLING_S, MOTOR_END_SHARE, ROTOR_RATE_HZ};

/// The thrust command over the mean rotor speed, s/rad, where the log's command is that speed in another unit.
pub fn command_per_speed(log: &Log) -> Option<f64> {
    let speeds = log.rotors.means().into_iter();
    let ratios: Vec<f64> = log.setpoint.rows.iter().zip(speeds).map(|(row, speed)| row[3] / speed).collect();
    let finite: Vec<f64> = ratios.into_iter().filter(|r| r.is_finite()).collect();
    let middle = median(&finite);
    let same = finite.iter().filter(|r| (*r / middle - 1.0).abs() < 1e-6).count() as f64;
    let enough = finite.len() > ROTOR_COMMAND_ROWS.count();
    (enough && same > ROTOR_COMMAND_SHARE.get() * finite.len() as f64).then_some(middle)
}

/// The motors or rotors that a stream has numbers above zero of, each as one column; none where there are fewer than
/// two, or where they come too slowly to tell a lag.
pub fn columns(stream: &Stream<MOTORS>) -> Option<Vec<Vec<f64>>> {
    let often = 1.0 / period(&stream.time_s) >= ROTOR_RATE_HZ.get();
    let working = |&k: &usize| stream.rows.iter().any(|row| row[k] > 0.0);
    let columns: Vec<Vec<f64>> = (0..stream.count()).filter(working).map(|k| stream.column(k)).collect();
    (often && columns.len() > 1).then_some(columns)
}

/// When a motor of the log is at an end of its range while another is not. There a flight controller cannot turn as it
/// wants to, and moves all motors together to turn all the same: the thrust is the mixer's, and not the command's.
pub fn mixing(log: &Log) -> Vec<Span> {
    let Some(columns) = columns(&log.motors) else { return Vec::new() };
    let all = || columns.iter().flatten().copied().filter(|u| u.is_finite());
    let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)));
    let near = MOTOR_END_SHARE.get() * (high - low);
    let at_end = |i: usize| {
        let at = |k: usize| columns[k][i] < low + near || columns[k][i] > high - near;
        let count = (0..columns.len()).filter(|&k| at(k)).count();
        count > 0 && count < columns.len()
    };
    let time = &log.motors.time_s;
    joined((0..time.len()).filter(|&i| at_end(i)).map(|i| [time[i], time[i] + MIXER_SETTLING_S.get()]).collect())
}
