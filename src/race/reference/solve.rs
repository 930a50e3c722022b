//! Newton's method down the barriers.

use super::barrier::{Slopes, slopes, value};
use super::course::{Course, Nodes};
use nalgebra::Vector3;

/// Weight of each barrier: at first, between stages, and at the end; s. At the end all barriers together cost less than
/// a thousandth of a lap.
const MU: [f64; 3] = [1e-2, 0.25, 2e-7];
/// Steps of Newton's method in a stage, and halvings of one.
const NEWTON: usize = 60;
const HALVINGS: usize = 40;
/// A stage ends where a step promises less than this many barriers' weight.
const SETTLED: f64 = 0.05;

/// The fastest lap near `lap`, which is slowed down first until it keeps every limit; from the weight `mu` on, s. None
/// where no speed keeps them.
pub fn solve(course: &Course, mut lap: Nodes, mu: Option<f64>) -> Option<Nodes> {
    let keeps = |lap: &Nodes| value(course, lap, 1.0).is_finite();
    for _ in 0..60 {
        if !keeps(&lap) {
            lap.seconds.iter_mut().for_each(|s| *s *= 1.2);
        }
    }
    if !keeps(&lap) {
        return None;
    }
    let mut mu = mu.unwrap_or(MU[0]);
    let mut derivatives = Slopes::new(&lap);
    loop {
        descend(course, &mut lap, mu, &mut derivatives);
        if mu <= MU[2] {
            return Some(lap);
        }
        mu = (mu * MU[1]).max(MU[2]);
    }
}

/// Newton's method at one weight.
fn descend(course: &Course, lap: &mut Nodes, mu: f64, derivatives: &mut Slopes) {
    let places = lap.places();
    let mut here = value(course, lap, mu);
    let mut shift = 0.0;
    for _ in 0..NEWTON {
        slopes(course, lap, mu, derivatives);
        let down: Vec<f64> = derivatives.gradient.iter().map(|g| -g).collect();
        // Where the function is not convex, the diagonal is raised until it looks so.
        let mut step = derivatives.matrix.solve(&down, shift);
        while step.is_none() && shift < 1e6 {
            shift = (10.0 * shift).max(1e-4);
            step = derivatives.matrix.solve(&down, shift);
        }
        let Some(step) = step else { return };
        let promised: f64 = step.iter().zip(&down).map(|(s, d)| s * d).sum();
        if promised < SETTLED * mu {
            return;
        }
        let durations = &step[3 * places.len()..];
        let longest = durations.iter().zip(&lap.seconds).map(|(d, s)| -d / s).fold(0.0, f64::max);
        let mut length = (0.7 / longest).min(1.0);
        let mut moved = None;
        for _ in 0..HALVINGS {
            let mut next = lap.clone();
            next.seconds.iter_mut().zip(durations).for_each(|(s, d)| *s += length * d);
            for (place, d) in places.iter().zip(step.chunks(3)) {
                let d = length * Vector3::from_column_slice(d);
                next.positions[place.nodes[1]] += place.gate.map_or(d, |gate| course.gates[gate].axes * d);
            }
            let there = value(course, &next, mu);
            if there < here - 0.1 * length * promised {
                moved = Some((next, there));
                break;
            }
            length *= 0.5;
        }
        let Some((next, there)) = moved else { return };
        (*lap, here) = (next, there);
        shift = if length == 1.0 { 0.1 * shift } else { shift };
        if shift < 1e-6 {
            shift = 0.0;
        }
    }
}
