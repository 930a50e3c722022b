//! Open loop: from where the flight was, with nothing but the logged commands, how far off is the simulation a moment
//! later?

use super::model::Model;
use super::predict::Predicted;
use super::record::FlightRecord;
use crate::model::attitude::{compose, in_world};
use crate::model::dynamics::extended::{self, Drive, Extended, RigidBody};
use serde::Serialize;

/// Moments at which the simulation is compared with the flight, s.
pub const AT_S: [f64; 3] = [0.25, 0.5, 1.0];
/// Time from one start to the next, s.
const EVERY_S: f64 = 0.7;

/// Root mean squares over all starts.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Horizon {
    /// After so long, s.
    pub after_s: f64,
    /// Of the velocity, m/s.
    pub velocity_m_s: f64,
    /// Of the position, m.
    pub position_m: f64,
    /// Of the attitude, deg.
    pub attitude_deg: f64,
    /// How many there were.
    pub starts: usize,
}

/// Where the simulation of one start got to, at each of [`AT_S`].
#[derive(Clone, Copy, Debug)]
struct Reached {
    sample: usize,
    body: RigidBody<f64>,
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
    let mut sums = [[0.0; 3]; AT_S.len()];
    let mut counts = [0usize; AT_S.len()];
    for run in &runs {
        for (at, end) in run.iter().enumerate() {
            let i = end.sample;
            let velocity = in_world(&record.axes[i], std::array::from_fn(|k| record.velocity[k][i]));
            let [w, a, b, c] = record.attitude[i];
            let turn = compose([w, -a, -b, -c], end.body.attitude);
            let angle = 2.0 * turn[1].hypot(turn[2]).hypot(turn[3]).min(1.0).asin();
            let apart = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>();
            let position: [f64; 3] = std::array::from_fn(|k| record.position[k][i]);
            let square =
                [apart(velocity, end.body.velocity), apart(position, end.body.position), angle.to_degrees().powi(2)];
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
        .map(|(a, b)| (0..3).map(|k| (a[last].body.velocity[k] - b[last].body.velocity[k]).powi(2)).sum::<f64>())
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
    let mut out = Vec::new();
    if !record.moves || !record.commanded[1] {
        return out;
    }
    let p = model.parameters(x);
    let n = record.time.len();
    let mut next_start = record.time.first().copied().unwrap_or(0.0);
    for start in 0..n {
        if record.time[start] < next_start {
            continue;
        }
        next_start = record.time[start] + EVERY_S;
        let end = record.time.partition_point(|&t| t <= record.time[start] + AT_S[2]);
        let known = (0..3).all(|k| record.velocity[k][start].is_finite())
            && record.attitude[start].iter().all(|x| x.is_finite());
        if end < n && known && (start..=end).all(|i| record.usable[i] && wanted(i)) {
            out.extend(<[Reached; 3]>::try_from(run(&p, record, state, [start, end])));
        }
    }
    out
}

/// From sample `start` to sample `end` under what was predicted of commands, body rates and voltage.
fn run(p: &Extended<f64>, record: &FlightRecord, state: &Predicted, [start, end]: [usize; 2]) -> Vec<Reached> {
    let at = |x: &[Vec<f64>; 3]| x.each_ref().map(|x| x[start]);
    let velocity = in_world(&record.axes[start], at(&record.velocity));
    let mut body = RigidBody { position: at(&record.position), velocity, attitude: record.attitude[start] };
    let since = record.since();
    let mut reached = Vec::new();
    for i in start..end {
        let drive = Drive {
            command: state.thrust(i),
            voltage: state.voltage[i],
            rates: std::array::from_fn(|k| 0.5 * (state.rates[i][k] + state.rates[i + 1][k])),
            height: record.height[start] + body.position[2] - record.position[2][start],
            turn_error: state.lag(i),
            elapsed: record.time[i] - since,
        };
        body = extended::moved(&body, p, &drive, record.time[i + 1] - record.time[i]);
        if reached.len() < AT_S.len() && record.time[i + 1] >= record.time[start] + AT_S[reached.len()] - 1e-6 {
            reached.push(Reached { sample: i + 1, body });
        }
    }
    reached
}
