//! What was measured, channel by channel.

use super::channels::{CHANNELS, FORCE, PUSH, TURN, VOLTAGE};
use super::record::FlightRecord;
use crate::model::attitude::{compose, in_world};

/// What was measured, in the layout of [`super::predict::Predicted::channels`].
pub fn measured(record: &FlightRecord, gravity: f64) -> [Vec<f64>; CHANNELS] {
    let mut out: [Vec<f64>; CHANNELS] = Default::default();
    for (c, channel) in out.iter_mut().enumerate().take(6) {
        let mean = |&[from, to]: &[usize; 2]| (from..to).map(|i| record.imu[c][i]).sum::<f64>() / (to - from) as f64;
        *channel = record.bins.iter().map(mean).collect();
    }
    let made = out[FORCE + 2].iter_mut().zip(&record.mixed).filter(|(_, mixed)| **mixed);
    made.for_each(|(force, _)| *force = f64::NAN);
    // Without attitude nothing is known of wind, or of a velocity that lags.
    for (bin, &[from, to]) in record.bins.iter().enumerate() {
        if (from..to).any(|i| !record.axes[i][0][0].is_finite()) {
            (FORCE..FORCE + 3).for_each(|c| out[c][bin] = f64::NAN);
        }
    }
    for window in &record.windows {
        let [from, to] = *window;
        let [w, a, b, c] = record.attitude[from];
        let turn = record.turn(compose([w, -a, -b, -c], record.attitude[to]), window);
        let velocity = |i: usize| in_world(&record.axes[i], std::array::from_fn(|k| record.velocity[k][i]));
        let (v0, v1) = (velocity(from), velocity(to));
        let mut gained: [f64; 3] = std::array::from_fn(|k| v1[k] - v0[k]);
        gained[2] += gravity * (record.time[to] - record.time[from]);
        for k in 0..3 {
            out[TURN + k].push(turn[k]);
            out[PUSH + k].push((0..3).map(|j| record.axes[from][k][j] * gained[j]).sum());
        }
    }
    out[VOLTAGE] = record.volts.iter().map(|(_, v)| *v).collect();
    out
}
