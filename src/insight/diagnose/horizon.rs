//! Open loop: from where the flight was, with nothing but the logged commands, how far off is the simulation a moment later?

use super::model::Model;
use super::predict::Predicted;
use super::record::FlightRecord;
use crate::model::attitude::{body_axes, compose, dot, normalized, small_rotation};
use crate::model::dynamics::extended::{self, ForceInputs};
use serde::Serialize;

/// Moments at which the simulation is compared with the flight, s.
pub const AT_S: [f64; 3] = [0.25, 0.5, 1.0];
/// Time from one start to the next, s.
const EVERY_S: f64 = 0.7;

/// Root mean squares over all starts.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Horizon {
    pub after_s: f64,
    pub velocity_m_s: f64,
    pub position_m: f64,
    pub attitude_deg: f64,
    pub starts: usize,
}

/// Where the simulation of one start got to, at each of [`AT_S`].
#[derive(Clone, Copy, Debug)]
struct Reached {
    sample: usize,
    velocity: [f64; 3],
    position: [f64; 3],
    attitude: [f64; 4],
}

/// Errors of the model at `x`, whose prediction is `state`, over the flight between samples of which `wanted` holds.
pub fn errors(
    model: &Model,
    record: &FlightRecord,
    state: &Predicted,
    x: &[f64],
    wanted: &dyn Fn(usize) -> bool,
) -> Vec<Horizon> {
    let runs = runs(model, record, state, x, wanted);
    let world = |i: usize, v: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|k| (0..3).map(|j| record.axes[i][j][k] * v[j]).sum())
    };
    let mut sums = [[0.0; 3]; AT_S.len()];
    let mut counts = [0usize; AT_S.len()];
    for run in &runs {
        for (at, end) in run.iter().enumerate() {
            let i = end.sample;
            let velocity = world(i, std::array::from_fn(|k| record.velocity[k][i]));
            let [w, a, b, c] = record.attitude[i];
            let turn = compose([w, -a, -b, -c], end.attitude);
            let angle = 2.0 * turn[1].hypot(turn[2]).hypot(turn[3]).min(1.0).asin();
            let apart = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>();
            let position: [f64; 3] = std::array::from_fn(|k| record.position[k][i]);
            let square = [apart(velocity, end.velocity), apart(position, end.position), angle.to_degrees().powi(2)];
            if square.iter().all(|x| x.is_finite()) {
                (0..3).for_each(|k| sums[at][k] += square[k]);
                counts[at] += 1;
            }
        }
    }
    let one = |at: usize| {
        let n = counts[at].max(1) as f64;
        let [velocity_m_s, position_m, attitude_deg] = sums[at].map(|s| (s / n).sqrt());
        Horizon { after_s: AT_S[at], velocity_m_s, position_m, attitude_deg, starts: counts[at] }
    };
    (0..AT_S.len()).map(one).collect()
}

/// Root mean square distance, m/s, of the velocities that two models reach after the longest time.
pub fn apart(model: &Model, record: &FlightRecord, a: (&Predicted, &[f64]), b: (&Predicted, &[f64])) -> f64 {
    let all = |_: usize| true;
    let (a, b) = (runs(model, record, a.0, a.1, &all), runs(model, record, b.0, b.1, &all));
    let last = AT_S.len() - 1;
    let squares: Vec<f64> = a
        .iter()
        .zip(&b)
        .map(|(a, b)| (0..3).map(|k| (a[last].velocity[k] - b[last].velocity[k]).powi(2)).sum::<f64>())
        .filter(|s| s.is_finite())
        .collect();
    crate::base::stats::mean(&squares).sqrt()
}

fn runs(
    model: &Model,
    record: &FlightRecord,
    state: &Predicted,
    x: &[f64],
    wanted: &dyn Fn(usize) -> bool,
) -> Vec<[Reached; 3]> {
    let p = model.parameters(x);
    let n = record.time.len();
    let since = record.since();
    let mut out = Vec::new();
    if !record.moves || !record.commanded[1] {
        return out;
    }
    let mut next_start = record.time.first().copied().unwrap_or(0.0);
    let gravity = model.vehicle().gravity_m_s2;
    for start in 0..n {
        if record.time[start] < next_start {
            continue;
        }
        next_start = record.time[start] + EVERY_S;
        let end = record.time.partition_point(|&t| t <= record.time[start] + AT_S[2]);
        let begins: [f64; 3] = std::array::from_fn(|k| record.velocity[k][start]);
        let known = begins.iter().chain(&record.attitude[start]).all(|x| x.is_finite());
        if end >= n || !known || !(start..=end).all(|i| record.usable[i] && wanted(i)) {
            continue;
        }
        let mut attitude = record.attitude[start];
        let axes = body_axes(attitude);
        let mut velocity: [f64; 3] = std::array::from_fn(|k| (0..3).map(|j| axes[j][k] * begins[j]).sum());
        let mut position: [f64; 3] = std::array::from_fn(|k| record.position[k][start]);
        let mut reached = Vec::new();
        for i in start..end {
            let h = record.time[i + 1] - record.time[i];
            let rates: [f64; 3] = std::array::from_fn(|k| 0.5 * (state.rates[i][k] + state.rates[i + 1][k]));
            let half = small_rotation(rates, 0.5 * h);
            let middle = compose(attitude, half);
            let axes = body_axes(middle);
            let body = std::array::from_fn(|k| dot(axes[k], velocity));
            let inputs = ForceInputs {
                command: state.thrust(i),
                voltage: state.voltage[i],
                axes,
                velocity: body,
                rates,
                height: record.height[start] + position[2] - record.position[2][start],
                rate_error: state.lag(i),
                elapsed: record.time[i] - since,
            };
            let force = extended::force(&p, &inputs);
            let before = velocity;
            for k in 0..3 {
                let pushed: f64 = (0..3).map(|j| axes[j][k] * force[j]).sum();
                velocity[k] += h * (pushed - if k == 2 { gravity } else { 0.0 });
                position[k] += 0.5 * h * (before[k] + velocity[k]);
            }
            attitude = normalized(compose(middle, half));
            if reached.len() < AT_S.len() && record.time[i + 1] >= record.time[start] + AT_S[reached.len()] - 1e-6 {
                reached.push(Reached { sample: i + 1, velocity, position, attitude });
            }
        }
        if let Ok(all) = <[Reached; 3]>::try_from(reached) {
            out.push(all);
        }
    }
    out
}
