//! The thrust curve of a vehicle (paper Eq. 7) that is nearest to another law of the throttle and the voltage: over
//! what was flown its largest error is the least there is, elsewhere the squares of its errors.

use super::force_terms::ForceTerms;
use crate::insight::estimate::halfspace::{Halfspace, minimum};
use crate::model::thrust::{shape, specific_thrust};
use nalgebra::DMatrix;

/// Commands and voltages at which the two are compared, and the mean weight of those that were flown.
const COMMANDS: i32 = 20;
const VOLTAGES: i32 = 2;
const FLOWN_WEIGHT: f64 = 25.0;
/// Rounds of Lawson's method: weights of the flown grow with their errors until the largest are as large as each other.
const ROUNDS: usize = 30;

/// What was flown: commands, -1..1, and voltages, V.
#[derive(Clone, Copy, Debug)]
pub struct FlownRange {
    pub commands: [f64; 2],
    pub volts: [f64; 2],
}

impl FlownRange {
    /// Commands and voltages, those of the pack and those that were flown; and whether a pair was.
    fn grid(&self, pack: [f64; 2]) -> Vec<([f64; 2], bool)> {
        let between = |[low, high]: [f64; 2], k: i32, n: i32| low + (high - low) * f64::from(k) / f64::from(n);
        let volts = |range: [f64; 2]| (0..=VOLTAGES).map(move |k| between(range, k, VOLTAGES));
        let commands = |range: [f64; 2]| (0..=COMMANDS).map(move |k| between(range, k, COMMANDS));
        let all = volts(pack).flat_map(|v| commands([-1.0, 1.0]).map(move |u| ([u, v], false)));
        let flown = volts(self.volts).flat_map(|v| commands(self.commands).map(move |u| ([u, v], true)));
        all.chain(flown).collect()
    }
}

/// The curve, as weights of the terms' curves, and its derivative by the numbers of the law: `law` says the thrust at a
/// command and a voltage, and its derivative by each of them.
pub fn nearest(
    terms: &ForceTerms,
    flown: FlownRange,
    law: &dyn Fn(f64, f64) -> (f64, Vec<f64>),
) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let n = terms.curves.len();
    let limits = shape::limits(terms.volts, terms.gravity, flown.commands);
    let limits: Vec<Halfspace> =
        limits.iter().map(|l| Halfspace { row: l.row[..n].to_vec(), least: l.least }).collect();
    let point = |([u, v], flown): ([f64; 2], bool)| {
        let row: Vec<f64> = terms.curves.iter().map(|c| specific_thrust(c, u, v)).collect();
        let (thrust, by) = law(u, v);
        GridPoint { row, thrust, by, weight: if flown { FLOWN_WEIGHT } else { 1.0 }, flown }
    };
    let mut points: Vec<GridPoint> = flown.grid(terms.volts).into_iter().map(point).collect();
    let numbers = points.first()?.by.len();
    let mut found: Option<(f64, Vec<f64>, DMatrix<f64>)> = None;
    for _ in 0..ROUNDS {
        let sum = |of: &dyn Fn(&GridPoint) -> f64| points.iter().map(|p| p.weight * of(p)).sum::<f64>();
        let normal = DMatrix::from_fn(n, n, |a, b| sum(&|p| p.row[a] * p.row[b]));
        let by_law = DMatrix::from_fn(n, numbers, |a, b| sum(&|p| p.row[a] * p.by[b]));
        let right: Vec<f64> = (0..n).map(|a| sum(&|p| p.row[a] * p.thrust)).collect();
        let curve = minimum(&normal, &vec![0.0; n], &right, &limits)?;
        let error = |p: &GridPoint| (p.row.iter().zip(&curve).map(|(a, b)| a * b).sum::<f64>() - p.thrust).abs();
        let told = points.iter().filter(|p| p.flown);
        let (count, worst) = told.clone().fold((0.0, 0.0f64), |(n, worst), p| (n + 1.0, worst.max(error(p))));
        let mean = told.map(|p| p.weight * error(p)).sum::<f64>() / (count * FLOWN_WEIGHT);
        // The same without limits takes a covariance along.
        let map = normal.cholesky()?.solve(&by_law);
        if found.as_ref().is_none_or(|(least, ..)| worst < *least) {
            found = Some((worst, curve.clone(), map));
        }
        if mean <= 0.0 {
            break;
        }
        points.iter_mut().filter(|p| p.flown).for_each(|p| p.weight *= error(p) / mean);
    }
    found.map(|(_, curve, map)| (curve, map))
}

/// A command and a voltage.
struct GridPoint {
    /// Thrust of each of the terms' curves.
    row: Vec<f64>,
    /// Thrust of the law, and its derivative by each of its numbers.
    thrust: f64,
    by: Vec<f64>,
    weight: f64,
    flown: bool,
}
