//! Signals that the simulation knows, beside the residuals: what structure may line up with.

use super::problem::{Predictions, Problem};

/// Signals at the rows of channel `c`, with their names and units.
pub fn signals(problem: &Problem, state: &Predictions, c: usize) -> Vec<(&'static str, &'static str, Vec<f64>)> {
    let rows = &problem.rows[c];
    let at = |f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        rows.iter().map(|row| f(row.flight as usize, row.sample as usize)).collect()
    };
    let records = &problem.records;
    let u = |f: usize, i: usize| state[f].thrust(i);
    let s = move |f: usize, i: usize| 0.5 + 0.5 * u(f, i);
    let before = |f: usize, i: usize| u(f, i) - u(f, i.saturating_sub(8));
    let v = |k: usize| move |f: usize, i: usize| records[f].velocity[k][i];
    let over_ground = |f: usize, i: usize| v(0)(f, i).hypot(v(1)(f, i));
    let w = |k: usize| move |f: usize, i: usize| state[f].rates[i][k];
    let heading = |f: usize, i: usize| records[f].axes[i][0][1].atan2(records[f].axes[i][0][0]);
    let begins = problem.clocks();
    let clock = |f: usize, i: usize| begins[f] + records[f].time[i] - records[f].time[0];
    let middle = 0.5 * rows.last().map_or(0.0, |row| clock(row.flight as usize, row.sample as usize));
    // What a number that changed in flight leaves.
    let moved = |k: usize| move |f: usize, i: usize| v(k)(f, i) * (clock(f, i) / middle.max(1.0) - 1.0);
    vec![
        ("throttle", "share", at(&s)),
        ("change of throttle", "share", at(&before)),
        ("voltage", "V", at(&|f, i| state[f].modelled_v[i])),
        ("forward speed", "m/s", at(&v(0))),
        ("sideways speed", "m/s", at(&v(1))),
        ("vertical speed", "m/s", at(&v(2))),
        ("speed across the rotors", "m/s", at(&over_ground)),
        ("throttle times vertical speed", "m/s", at(&|f, i| s(f, i) * v(2)(f, i))),
        ("speed across times vertical speed", "m2/s2", at(&|f, i| over_ground(f, i) * v(2)(f, i))),
        ("height", "m", at(&|f, i| records[f].height[i].min(50.0))),
        ("time", "s", at(&clock)),
        ("forward speed times time", "m/s", at(&moved(0))),
        ("sideways speed times time", "m/s", at(&moved(1))),
        ("heading", "rad", at(&heading)),
        ("roll rate", "rad/s", at(&w(0))),
        ("pitch rate", "rad/s", at(&w(1))),
        ("yaw rate", "rad/s", at(&w(2))),
        ("yaw rate times forward speed", "m/s2", at(&|f, i| w(2)(f, i) * v(0)(f, i))),
        ("yaw rate times sideways speed", "m/s2", at(&|f, i| w(2)(f, i) * v(1)(f, i))),
        ("lag of the rates", "full sticks", at(&|f, i| state[f].lag(i).share)),
        ("position east", "m", at(&|f, i| records[f].position[0][i])),
        ("position north", "m", at(&|f, i| records[f].position[1][i])),
    ]
}
