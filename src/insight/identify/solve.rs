//! Bounded nonlinear least squares with robust weights, and intervals that hold for coloured noise.

use crate::base::stats::{NORMAL_95, robust_sd};
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::halfspace::{Halfspace, minimum};
use crate::insight::estimate::jackknife::jackknife;
use crate::insight::estimate::least_squares::{Bounded, Normal, Shorter};
use crate::insight::estimate::robust::huber;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Residuals beyond so many standard deviations weigh less (Huber): next to nothing of normal noise, all of a glitch.
const HUBER: f64 = 3.0;
/// Most steps, each with new weights, and the relative gain below which they end.
const STEPS: usize = 25;
const ENOUGH: f64 = 1e-7;

/// A number to be found.
#[derive(Clone, Copy, Debug)]
pub struct Unknown {
    pub start: f64,
    /// Bounds.
    pub low: f64,
    pub high: f64,
    /// Size of a physically small change, for derivatives.
    pub step: f64,
    /// Whether the residuals are linear in it, so that one side of a derivative is enough.
    pub linear: bool,
}

/// Where a fit ended.
#[derive(Clone, Debug)]
pub struct Solution {
    pub values: Vec<f64>,
    /// Covariance over blocks; zero for values at a bound.
    pub covariance: DMatrix<f64>,
    /// Whether a value ended at one of its bounds.
    pub at_bound: Vec<bool>,
    /// Standard deviation of the residuals of each channel.
    pub noise: Vec<f64>,
}

impl Solution {
    /// Half the width of the 95 % interval of value `i`.
    pub fn half_width(&self, i: usize) -> f64 {
        NORMAL_95 * self.covariance[(i, i)].max(0.0).sqrt()
    }
}

/// Residuals of each channel at these values.
pub type Residuals<'a> = dyn Fn(&[f64]) -> Vec<Vec<f64>> + Sync + 'a;

/// Minimises the weighted squares of `residuals(values)`: channels of equally many samples. `blocks` numbers the
/// stretch of time of each sample: residuals of different stretches are taken for independent, those of one are not.
/// `None` where there are fewer stretches than unknowns, or the residuals are not finite.
pub fn solve(unknowns: &[Unknown], blocks: &[u32], residuals: &Residuals) -> Option<Solution> {
    solve_within(unknowns, &[], blocks, residuals)
}

/// The same under linear inequalities beside the bounds. The covariance is that without them: it says what the data
/// know.
pub fn solve_within(
    unknowns: &[Unknown],
    within: &[Halfspace],
    blocks: &[u32],
    residuals: &Residuals,
) -> Option<Solution> {
    let stretches = blocks.iter().collect::<BTreeSet<_>>().len();
    if stretches <= unknowns.len() {
        return None;
    }
    let mut values = start(unknowns, within)?;
    let mut damping = 1e-6;
    for _ in 0..STEPS {
        let weights = RobustWeights::of(&residuals(&values))?;
        let system = Linearised::at(unknowns, &values, &weights, blocks, residuals)?;
        let cost = |x: &[f64]| weights.cost(&residuals(x));
        if !system.descend(unknowns, within, &mut values, &mut damping, &cost) {
            break;
        }
    }
    let weights = RobustWeights::of(&residuals(&values))?;
    let system = Linearised::at(unknowns, &values, &weights, blocks, residuals)?;
    let (covariance, at_bound) = system.covariance(unknowns, &values)?;
    Some(Solution { values, covariance, at_bound, noise: weights.noise })
}

/// The starts, within bounds and half-spaces: the nearest to what was asked for, in small changes.
fn start(unknowns: &[Unknown], within: &[Halfspace]) -> Option<Vec<f64>> {
    let asked: Vec<f64> = unknowns.iter().map(|u| u.start.clamp(u.low, u.high)).collect();
    if within.iter().all(|h| h.room(&asked) >= 0.0) {
        return Some(asked);
    }
    let n = unknowns.len();
    let scale: Vec<f64> = unknowns.iter().map(|u| u.step.powi(-2)).collect();
    let mut rows: Vec<Halfspace> = Vec::new();
    for (i, u) in unknowns.iter().enumerate() {
        rows.push(Halfspace::bound(i, n, 1.0, u.low - asked[i]));
        rows.push(Halfspace::bound(i, n, -1.0, asked[i] - u.high));
    }
    rows.extend(within.iter().map(|h| Halfspace { row: h.row.clone(), least: -h.room(&asked) }));
    let matrix = DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(&scale));
    let by = minimum(&matrix, &vec![0.0; n], &vec![0.0; n], &rows)?;
    Some(asked.iter().zip(by).map(|(x, by)| x + by).collect())
}

/// Weight of every sample.
struct RobustWeights {
    noise: Vec<f64>,
    of: Vec<Vec<f64>>,
}

impl RobustWeights {
    fn of(residuals: &[Vec<f64>]) -> Option<Self> {
        let noise: Vec<f64> = residuals.iter().map(|r| robust_sd(r).max(1e-9)).collect();
        if noise.iter().any(|sd| !sd.is_finite()) {
            return None;
        }
        let weigh = |(r, sd): (&Vec<f64>, &f64)| r.iter().map(|r| huber(r / sd, HUBER) / (sd * sd)).collect::<Vec<_>>();
        Some(RobustWeights { of: residuals.iter().zip(&noise).map(weigh).collect(), noise })
    }

    fn cost(&self, residuals: &[Vec<f64>]) -> f64 {
        let channel = |(r, w): (&Vec<f64>, &Vec<f64>)| r.iter().zip(w).map(|(r, w)| w * r * r).sum::<f64>();
        residuals.iter().zip(&self.of).map(channel).sum()
    }

    /// `values` by channel, times the square roots of the weights.
    fn weigh(&self, values: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let channel = |(v, w): (&Vec<f64>, &Vec<f64>)| v.iter().zip(w).map(|(v, w)| v * w.sqrt()).collect();
        values.iter().zip(&self.of).map(channel).collect()
    }
}

/// Residuals at `values`, and the products of their weighted derivatives by each unknown, with themselves last.
struct Linearised {
    cost: f64,
    grams: Grams,
}

impl Linearised {
    fn at(
        unknowns: &[Unknown],
        values: &[f64],
        weights: &RobustWeights,
        blocks: &[u32],
        residuals: &Residuals,
    ) -> Option<Self> {
        let here = residuals(values);
        let slopes = |k: usize| weights.weigh(&slope(unknowns, values, k, &here, residuals));
        let mut columns: Vec<_> = (0..values.len()).into_par_iter().map(slopes).collect();
        columns.push(weights.weigh(&here));
        let rows = vec![blocks.to_vec(); here.len()];
        let stretches = blocks.iter().max().map_or(0, |last| *last as usize + 1);
        let grams = Grams::new(&columns.iter().collect::<Vec<_>>(), &rows, stretches);
        grams.sum.iter().all(|x| x.is_finite()).then(|| Linearised { cost: weights.cost(&here), grams })
    }

    /// Where the squares fall: J'(measured - predicted).
    fn downhill(&self, i: usize) -> f64 {
        -self.grams.sum[(i, self.grams.sum.ncols() - 1)]
    }

    /// The unknowns that are told: not at a bound that the descent pushes against, and with any effect at all.
    fn told(&self, unknowns: &[Unknown], values: &[f64]) -> Vec<usize> {
        let blocked = |i: usize| {
            let (u, x, downhill) = (&unknowns[i], values[i], self.downhill(i));
            x <= u.low && downhill <= 0.0 || x >= u.high && downhill >= 0.0
        };
        (0..values.len()).filter(|&i| !blocked(i) && self.grams.sum[(i, i)] > 0.0).collect()
    }

    /// One step within the bounds. Whether it was worth another.
    fn descend(
        &self,
        unknowns: &[Unknown],
        within: &[Halfspace],
        values: &mut Vec<f64>,
        damping: &mut f64,
        cost: &dyn Fn(&[f64]) -> f64,
    ) -> bool {
        let n = values.len();
        let own = self.grams.sum.view((0, 0), (n, n)).into_owned();
        let downhill = (0..n).map(|i| self.downhill(i)).collect();
        let normal = Normal { matrix: &own, downhill, ridge: vec![0.0; n], within };
        let bounded = |(u, &value): (&Unknown, &f64)| Bounded { value, low: u.low, high: u.high };
        let at: Vec<Bounded> = unknowns.iter().zip(values.iter()).map(bounded).collect();
        let Some((next, lower, ())) = normal.descend(&at, Shorter::Damped(damping), self.cost, |x| (cost(x), ()))
        else {
            return false;
        };
        *values = next;
        self.cost - lower > ENOUGH * self.cost
    }

    /// Covariance of all unknowns, zero for those that are not told, and which are not.
    fn covariance(&self, unknowns: &[Unknown], values: &[f64]) -> Option<(DMatrix<f64>, Vec<bool>)> {
        let (n, told) = (values.len(), self.told(unknowns, values));
        let (inner, _) = jackknife(&self.grams, &told, n, &vec![0.0; told.len()], 1)?;
        let mut covariance = DMatrix::zeros(n, n);
        for (row, &i) in told.iter().enumerate() {
            for (column, &j) in told.iter().enumerate() {
                covariance[(i, j)] = inner[(row, column)];
            }
        }
        Some((covariance, (0..n).map(|i| !told.contains(&i)).collect()))
    }
}

/// Derivative of each channel's residuals by unknown `k`, from those `here` and those a small change away.
fn slope(unknowns: &[Unknown], values: &[f64], k: usize, here: &[Vec<f64>], residuals: &Residuals) -> Vec<Vec<f64>> {
    let moved = |by: f64| {
        let mut values = values.to_vec();
        values[k] = (values[k] + by).clamp(unknowns[k].low, unknowns[k].high);
        (values[k], residuals(&values))
    };
    let (x1, above) = moved(unknowns[k].step);
    let (x0, below) =
        if unknowns[k].linear && x1 > values[k] { (values[k], here.to_vec()) } else { moved(-unknowns[k].step) };
    let scale = 1.0 / (x1 - x0);
    let channel = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| (a - b) * scale).collect();
    above.iter().zip(&below).map(channel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};
    use rand::RngExt;
    use rand_distr::StandardNormal;

    /// y = a exp(-t / b) with white noise and a few gross outliers.
    fn data(seed: u64) -> (Vec<f64>, Vec<f64>, Vec<u32>) {
        let mut rng = Philox::new(seed).sequence(RngStream::Noise, 0, 0);
        let t: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.002).collect();
        let mut y: Vec<f64> =
            t.iter().map(|t| 3.0 * (-t / 0.7).exp() + 0.1 * rng.sample::<f64, _>(StandardNormal)).collect();
        (0..2000).step_by(97).for_each(|i| y[i] += 50.0);
        let blocks = (0..2000).map(|i| i / 50).collect();
        (t, y, blocks)
    }

    fn unknown(start: f64, low: f64, high: f64) -> Unknown {
        Unknown { start, low, high, step: 1e-4, linear: false }
    }

    #[test]
    fn values_and_intervals_hold_with_outliers() {
        let mut inside = 0;
        for seed in 0..160 {
            let (t, y, blocks) = data(seed);
            let residuals =
                |x: &[f64]| vec![t.iter().zip(&y).map(|(t, y)| x[0] * (-t / x[1]).exp() - y).collect::<Vec<_>>()];
            let found = solve(&[unknown(1.0, 0.0, 10.0), unknown(0.2, 0.01, 5.0)], &blocks, &residuals).unwrap();
            assert!((found.values[0] - 3.0).abs() < 0.1 && (found.values[1] - 0.7).abs() < 0.03, "{:?}", found.values);
            inside += usize::from((found.values[0] - 3.0).abs() < found.half_width(0));
            inside += usize::from((found.values[1] - 0.7).abs() < found.half_width(1));
            assert!((found.noise[0] - 0.1).abs() < 0.01);
        }
        // 95 % of 320, less some 3 % that outliers to one side take; both values move together, so that four standard
        // deviations are 20.
        assert!((275..=315).contains(&inside), "{inside}");
    }

    #[test]
    fn half_spaces_hold_where_the_data_would_leave_them() {
        let (t, y, blocks) = data(1);
        let residuals =
            |x: &[f64]| vec![t.iter().zip(&y).map(|(t, y)| x[0] * (-t / x[1]).exp() - y).collect::<Vec<_>>()];
        // 3 and 0.7 add up to more than 3.5; the start lies outside as well.
        let within = [Halfspace { row: vec![-1.0, -1.0], least: -3.5 }];
        let unknowns = [unknown(4.0, 0.0, 10.0), unknown(0.2, 0.01, 5.0)];
        let found = solve_within(&unknowns, &within, &blocks, &residuals).unwrap();
        assert!((found.values[0] + found.values[1] - 3.5).abs() < 1e-6, "{:?}", found.values);
        assert!(found.half_width(0) > 0.0);
    }

    #[test]
    fn bounds_hold_and_are_told() {
        let (t, y, blocks) = data(1);
        let residuals =
            |x: &[f64]| vec![t.iter().zip(&y).map(|(t, y)| x[0] * (-t / x[1]).exp() - y).collect::<Vec<_>>()];
        let found = solve(&[unknown(1.0, 0.0, 10.0), unknown(0.2, 0.01, 0.5)], &blocks, &residuals).unwrap();
        assert_eq!((found.values[1], found.at_bound.clone()), (0.5, vec![false, true]));
        assert_eq!(found.half_width(1), 0.0);
        assert!(solve(&[unknown(1.0, 0.0, 2.0)], &vec![0; 2000], &residuals).is_none(), "one stretch is not enough");
    }
}
