//! The accelerometer's bias, from kinematics alone: what it integrates to against the change of velocity.

use super::solve::{Solution, Unknown, solve};
use crate::flight::spans::contain;
use crate::insight::prepare::data::Data;
use crate::insight::prepare::flight::PreparedFlight;
use crate::insight::prepare::windows::{often_enough, windows};
use crate::model::attitude::{body_axes, in_world};

/// Length of the stretches compared, s: twice the diagnosis's, for what is looked for here is constant.
const OVER_S: f64 = 0.5;

/// One comparison: change of velocity less gravity less integrated specific force, and the integrated rotation; world.
struct BiasWindow {
    block: u32,
    missing: [f64; 3],
    rotation: [[f64; 3]; 3],
}

/// Fits the bias along body x, y, z, m/s2. `None` without odometry that is fast enough and knows attitude and velocity.
pub fn fit(data: &Data, gravity: f64) -> Option<Solution> {
    let stretches: Vec<BiasWindow> = data.flights.iter().flat_map(|flight| stretches(flight, gravity)).collect();
    let blocks: Vec<u32> = stretches.iter().map(|s| s.block).collect();
    let residuals = |b: &[f64]| {
        let axis = |k: usize| {
            // The bias makes the accelerometer integrate to too much: the change of velocity lacks it.
            let one = |s: &BiasWindow| s.missing[k] + (0..3).map(|j| s.rotation[j][k] * b[j]).sum::<f64>();
            stretches.iter().map(one).collect::<Vec<f64>>()
        };
        (0..3).map(axis).collect()
    };
    solve(&[Unknown { start: 0.0, low: -3.0, high: 3.0, step: 1e-3, linear: true }; 3], &blocks, &residuals)
}

fn stretches(flight: &PreparedFlight, gravity: f64) -> Vec<BiasWindow> {
    if !often_enough(&flight.quality.log.odometry) {
        return Vec::new();
    }
    let spans = &flight.quality.usable;
    let usable = |ends: [usize; 2]| ends.iter().all(|&i| contain(spans, flight.time[i]));
    let force: [Vec<f64>; 3] = std::array::from_fn(|k| flight.measured(3 + k));
    let all = windows(&flight.time, OVER_S, usable).into_iter().map(|window| stretch(flight, &force, window, gravity));
    all.filter(|stretch| stretch.missing.iter().all(|x| x.is_finite())).collect()
}

fn stretch(flight: &PreparedFlight, force: &[Vec<f64>; 3], [from, to]: [usize; 2], gravity: f64) -> BiasWindow {
    let mut rotation = [[0.0; 3]; 3];
    let mut pushed = [0.0; 3];
    for i in from..to {
        let half = 0.5 * (flight.time[i + 1] - flight.time[i]);
        for i in [i, i + 1] {
            let axes = body_axes(flight.attitude[i]);
            let push = in_world(&axes, force.each_ref().map(|f| f[i]));
            for k in 0..3 {
                pushed[k] += half * push[k];
                (0..3).for_each(|j| rotation[j][k] += half * axes[j][k]);
            }
        }
    }
    let velocity = |i: usize| in_world(&body_axes(flight.attitude[i]), flight.velocity.each_ref().map(|v| v[i]));
    let (before, after) = (velocity(from), velocity(to));
    let fallen = [0.0, 0.0, gravity * (flight.time[to] - flight.time[from])];
    let missing = std::array::from_fn(|k| after[k] - before[k] + fallen[k] - pushed[k]);
    BiasWindow { block: flight.block[from], missing, rotation }
}
