//! A recorded flight, to be shown.

use super::{Replay, ReplayFrame, ReplayVehicle, laps};
use crate::base::check::BadInput;
use crate::flight::Log;
use crate::flight::series::{held, interpolated};
use crate::model::attitude::body_axes;
use crate::model::track::Track;
use crate::race::env::gates::{crossing, frames};

/// Longest gap that numbers are interpolated over, s.
const REACH_S: f64 = 0.5;

/// What `log` recorded, with the gates of `track` where it is known which track was flown. Fails where the log does not
/// say where the vehicle was.
pub fn recorded(log: &Log, track: Option<&Track>) -> Result<Replay, BadInput> {
    let poses = &log.odometry;
    let known = |row: &[f64; 10]| row[..7].iter().all(|x| x.is_finite());
    let mut kept: Vec<usize> =
        (0..poses.len()).filter(|&i| known(&poses.rows[i]) && poses.time_s[i].is_finite()).collect();
    // A receiver that starts anew may send old times again.
    let mut latest = f64::NEG_INFINITY;
    kept.retain(|&i| {
        let later = poses.time_s[i] > latest;
        latest = latest.max(poses.time_s[i]);
        later
    });
    if kept.len() < 2 {
        let advice = "`racer check` shows what the log holds; a mapping may name the fields";
        let found = format!("{} samples of position and attitude", kept.len());
        return Err(BadInput::new(&log.name, found, "position and attitude over time", advice));
    }
    let times: Vec<f64> = kept.iter().map(|&i| poses.time_s[i]).collect();
    let rates: [Vec<f64>; 3] = std::array::from_fn(|k| sampled(&log.imu.time_s, &log.imu.column(k), &times, true));
    let full = log.vehicle.max_rate_rad_s;
    let commands: [Vec<f64>; 4] = std::array::from_fn(|k| {
        let values = sampled(&log.setpoint.time_s, &log.setpoint.column(k), &times, false);
        let scaled = |x: f64| match (k, full) {
            (3, _) => 2.0 * x - 1.0,
            (_, Some(full)) => x / full[k],
            // Without the rate of a full stick its share is not known.
            (_, None) => f64::NAN,
        };
        values.into_iter().map(scaled).collect()
    });
    let voltage = sampled(&log.battery.time_s, &log.battery.column(0), &times, true);
    let mut all: Vec<ReplayFrame> = Vec::with_capacity(kept.len());
    for (n, &i) in kept.iter().enumerate() {
        let [x, y, z, qw, qx, qy, qz, u, v, w] = poses.rows[i];
        let axes = body_axes([qw, qx, qy, qz]);
        all.push(ReplayFrame {
            time_s: times[n],
            position: [x, y, z],
            velocity: std::array::from_fn(|k| axes[0][k] * u + axes[1][k] * v + axes[2][k] * w),
            attitude: [qw, qx, qy, qz],
            rates: std::array::from_fn(|k| rates[k][n]),
            command: std::array::from_fn(|k| commands[k][n]),
            voltage: voltage[n],
            target: None,
            observation: None,
        });
    }
    let passes = track.map_or(Vec::new(), |track| pass(&mut all, track));
    let vehicle = ReplayVehicle { name: "recorded".into(), frames: all, laps: laps(&passes), passes, failure: None };
    Ok(Replay { title: log.name.clone(), start_ns: log.start_ns, track: track.cloned(), vehicles: vec![vehicle] })
}

/// `values` at `times`, linear in between or held; NaN where there are none.
fn sampled(at: &[f64], values: &[f64], times: &[f64], linear: bool) -> Vec<f64> {
    if at.is_empty() {
        vec![f64::NAN; times.len()]
    } else if linear {
        interpolated(at, values, times, REACH_S)
    } else {
        held(at, values, times)
    }
}

/// The gates that the flight passed in their order, from whichever it passed first; sets the gates flown to.
fn pass(flight: &mut [ReplayFrame], track: &Track) -> Vec<(f64, usize)> {
    let gates = frames(track, None);
    let mut passes: Vec<(f64, usize)> = Vec::new();
    let mut target = None;
    for i in 1..flight.len() {
        flight[i - 1].target = target;
        let [before, after] = [i - 1, i].map(|i| flight[i].position.map(|x| x as f32));
        let candidates = target.map_or(0..gates.len(), |gate| gate..gate + 1);
        for g in candidates {
            let step = crossing(gates[g].locate(before), gates[g].locate(after), gates[g].radius);
            if step.passed {
                let span = flight[i].time_s - flight[i - 1].time_s;
                passes.push((flight[i - 1].time_s + f64::from(step.fraction) * span, g));
                target = Some((g + 1) % gates.len());
                break;
            }
        }
    }
    passes
}
