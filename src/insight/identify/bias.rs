//! The accelerometer's bias, from kinematics alone: what it integrates to against the change of velocity.

use super::data::Data;
use super::flight::Flight;
use super::solve::{Solution, Unknown, solve};
use crate::flight::series::{interpolated, period};
use crate::flight::spans::contain;
use crate::model::attitude::body_axes;

/// Length of the stretches compared, s.
const OVER_S: f64 = 0.5;
/// Odometry slower than this cannot be integrated over, Hz.
const LEAST_RATE_HZ: f64 = 40.0;

/// One comparison: change of velocity less gravity less integrated specific force, and the integrated rotation; world.
struct Stretch {
    block: u32,
    missing: [f64; 3],
    rotation: [[f64; 3]; 3],
}

/// Fits the bias along body x, y, z, m/s2. `None` without odometry that is fast enough and knows attitude and velocity.
pub fn fit(data: &Data, gravity: f64) -> Option<Solution> {
    let stretches: Vec<Stretch> = data.flights.iter().flat_map(|flight| stretches(flight, gravity)).collect();
    let blocks: Vec<u32> = stretches.iter().map(|s| s.block).collect();
    let residuals = |b: &[f64]| {
        let axis = |k: usize| {
            // The bias makes the accelerometer integrate to too much: the change of velocity lacks it.
            let one = |s: &Stretch| s.missing[k] + (0..3).map(|j| s.rotation[j][k] * b[j]).sum::<f64>();
            stretches.iter().map(one).collect::<Vec<f64>>()
        };
        (0..3).map(axis).collect()
    };
    solve(&[Unknown { start: 0.0, low: -3.0, high: 3.0, step: 1e-3, linear: true }; 3], &blocks, &residuals)
}

fn stretches(flight: &Flight, gravity: f64) -> Vec<Stretch> {
    let odometry = &flight.quality.log.odometry;
    if odometry.is_empty() || 1.0 / period(&odometry.time_s) < LEAST_RATE_HZ {
        return Vec::new();
    }
    let attitude: [Vec<f64>; 4] =
        std::array::from_fn(|k| interpolated(&odometry.time_s, &odometry.column(3 + k), &flight.time, 0.1));
    let axes = |i: usize| {
        let q = [attitude[0][i], attitude[1][i], attitude[2][i], attitude[3][i]];
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        // Between a quaternion and its negative a line leads through nowhere near a rotation.
        let q = if norm > 0.9 { q.map(|x| x / norm) } else { [f64::NAN; 4] };
        body_axes(q)
    };
    let force: [Vec<f64>; 3] = std::array::from_fn(|k| flight.measured(3 + k));
    let in_world = |axes: &[[f64; 3]; 3], v: [f64; 3], k: usize| (0..3).map(|j| axes[j][k] * v[j]).sum::<f64>();
    let mut out = Vec::new();
    let mut from = 0;
    while from < flight.time.len() {
        let to = flight.time.partition_point(|&t| t < flight.time[from] + OVER_S);
        let spans = &flight.quality.usable;
        if to >= flight.time.len() || !contain(spans, flight.time[from]) || !contain(spans, flight.time[to]) {
            from = to.max(from + 1);
            continue;
        }
        let mut rotation = [[0.0; 3]; 3];
        let mut pushed = [0.0; 3];
        for i in from..to {
            let half = 0.5 * (flight.time[i + 1] - flight.time[i]);
            for i in [i, i + 1] {
                let axes = axes(i);
                for k in 0..3 {
                    pushed[k] += half * in_world(&axes, [force[0][i], force[1][i], force[2][i]], k);
                    (0..3).for_each(|j| rotation[j][k] += half * axes[j][k]);
                }
            }
        }
        let velocity = |i: usize, k: usize| {
            in_world(&axes(i), [flight.velocity[0][i], flight.velocity[1][i], flight.velocity[2][i]], k)
        };
        let fallen = gravity * (flight.time[to] - flight.time[from]);
        let missing: [f64; 3] = std::array::from_fn(|k| {
            let gained = velocity(to, k) - velocity(from, k) + if k == 2 { fallen } else { 0.0 };
            gained - pushed[k]
        });
        if missing.iter().all(|x| x.is_finite()) {
            out.push(Stretch { block: flight.block[from], missing, rotation });
        }
        from = to;
    }
    out
}
