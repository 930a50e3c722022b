//! What arrives of the commands, and what body rates it makes.

use super::model::Model;
use super::record::FlightRecord;
use crate::model::dynamics::extended::{self, Extended};
use crate::model::effects::Role;

/// The filtered commands at every sample.
pub struct ActuatorResponse {
    pub command: Vec<[f64; 4]>,
    pub lag: Vec<f64>,
    pub setpoint: Vec<([f64; 4], [f64; 3])>,
}

/// Body rates: those that the filtered commands make, or the gyro's where the log has no commands of them.
#[inline(always)]
pub fn body_rates(p: &Extended<f64>, record: &FlightRecord, command: &[[f64; 4]]) -> Vec<[f64; 3]> {
    if record.commanded[0] {
        command.iter().map(|c| extended::body_rates(p, *c)).collect()
    } else {
        (0..command.len()).map(|i| std::array::from_fn(|k| record.imu[k][i])).collect()
    }
}

/// Filtered commands at every sample; the gyro's samples are `offset` seconds late. Commands are held until the next,
/// and what arrives is integrated exactly.
#[inline(always)]
pub fn actuator_response(
    p: &Extended<f64>,
    record: &FlightRecord,
    model: &Model,
    x: &[f64],
    offset: f64,
) -> ActuatorResponse {
    let late = extended::command_delays(p);
    // Roll and pitch, yaw, and thrust arrive each at their time.
    let late = [late[0] + offset, late[2] + offset, late[3]];
    let stretch = 1.0 / (1.0 + model.acting(x, Role::ClockFast));
    let lost = model.acting(x, Role::CommandsLost);
    let n = record.time.len();
    let mut out = ActuatorResponse {
        command: Vec::with_capacity(n),
        lag: Vec::with_capacity(n),
        setpoint: Vec::with_capacity(n),
    };
    let none = [f64::NAN; 4];
    let Some((first, begin)) = record.sent.first().copied() else {
        return ActuatorResponse { command: vec![none; n], lag: vec![0.0; n], setpoint: vec![(none, [0.0; 3]); n] };
    };
    // What arrives on average where commands get lost.
    let arrives = |i: usize, k: usize| {
        let now = record.sent[i].1[k];
        if i == 0 || lost == 0.0 { now } else { now + lost * (record.sent[i - 1].1[k] - now) }
    };
    let mut at = [0, 0, 0];
    let (mut command, mut slope, mut sent) = (begin, [0.0; 3], begin);
    let mut now = first;
    for i in 0..n {
        let t = record.time[i] * stretch;
        if t < first {
            out.command.push(none);
            out.lag.push(f64::NAN);
            out.setpoint.push((none, [0.0; 3]));
            continue;
        }
        let voltage = supplied(p, record, i);
        loop {
            let due = |g: usize| record.sent.get(at[g] + 1).map_or(f64::INFINITY, |next| next.0 + late[g]);
            let (g, next) = if due(0) <= due(1).min(due(2)) {
                (0, due(0))
            } else if due(1) <= due(2) {
                (1, due(1))
            } else {
                (2, due(2))
            };
            let until = next.min(t);
            if until > now {
                (command, slope) = extended::actuator_response(p, command, slope, sent, voltage, until - now);
                now = until;
            }
            if next > t {
                break;
            }
            at[g] += 1;
            [0..2, 2..3, 3..4][g].clone().for_each(|k| sent[k] = arrives(at[g], k));
        }
        out.command.push(command);
        out.lag.push((0..3).map(|k| (sent[k] - command[k]).abs()).sum());
        out.setpoint.push((sent, slope));
    }
    out
}

/// The voltage that a sample's response depends on, V.
#[inline(always)]
pub fn supplied(p: &Extended<f64>, record: &FlightRecord, i: usize) -> f64 {
    if record.voltage[i].is_finite() { record.voltage[i] } else { p.full_v }
}
