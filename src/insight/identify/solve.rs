//! Bounded nonlinear least squares with robust weights, and intervals that hold for coloured noise.

use crate::base::stats::{NORMAL_95, robust_sd};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Residuals beyond so many standard deviations weigh less (Huber).
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

/// Minimises the weighted squares of `residuals(values)`: channels of equally many samples. `blocks` numbers the stretch of
/// time of each sample: residuals of different stretches are taken for independent, those of one are not.
/// `None` where there are fewer stretches than unknowns, or the residuals are not finite.
pub fn solve(
    unknowns: &[Unknown],
    blocks: &[u32],
    residuals: &(dyn Fn(&[f64]) -> Vec<Vec<f64>> + Sync),
) -> Option<Solution> {
    let stretches = blocks.iter().collect::<BTreeSet<_>>().len();
    if stretches <= unknowns.len() {
        return None;
    }
    let mut values: Vec<f64> = unknowns.iter().map(|u| u.start.clamp(u.low, u.high)).collect();
    let mut damping = 1e-6;
    for _ in 0..STEPS {
        let weights = Weights::of(&residuals(&values))?;
        let system = System::at(unknowns, &values, &weights, residuals)?;
        if !descend(unknowns, &mut values, &mut damping, &system, residuals) {
            break;
        }
    }
    let weights = Weights::of(&residuals(&values))?;
    let system = System::at(unknowns, &values, &weights, residuals)?;
    let (covariance, at_bound) = system.jackknife(unknowns, &values, blocks)?;
    Some(Solution { values, covariance, at_bound, noise: weights.noise })
}

/// Weight of every sample.
struct Weights {
    noise: Vec<f64>,
    of: Vec<Vec<f64>>,
}

impl Weights {
    fn of(residuals: &[Vec<f64>]) -> Option<Self> {
        let noise: Vec<f64> = residuals.iter().map(|r| robust_sd(r).max(1e-9)).collect();
        if noise.iter().any(|sd| !sd.is_finite()) {
            return None;
        }
        let weigh = |(r, sd): (&Vec<f64>, &f64)| {
            r.iter().map(|r| (HUBER * sd / r.abs()).min(1.0) / (sd * sd)).collect::<Vec<_>>()
        };
        Some(Weights { of: residuals.iter().zip(&noise).map(weigh).collect(), noise })
    }

    fn cost(&self, residuals: &[Vec<f64>]) -> f64 {
        let channel = |(r, w): (&Vec<f64>, &Vec<f64>)| r.iter().zip(w).map(|(r, w)| w * r * r).sum::<f64>();
        residuals.iter().zip(&self.of).map(channel).sum()
    }
}

/// Residuals, their derivatives, and the normal equations.
struct System<'a> {
    weights: &'a Weights,
    residuals: Vec<Vec<f64>>,
    /// Of each unknown: derivative of each channel's residuals.
    slopes: Vec<Vec<Vec<f64>>>,
    normal: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl<'a> System<'a> {
    fn at(
        unknowns: &[Unknown],
        values: &[f64],
        weights: &'a Weights,
        residuals: &(dyn Fn(&[f64]) -> Vec<Vec<f64>> + Sync),
    ) -> Option<Self> {
        let residuals_here = residuals(values);
        let slope = |k: usize| {
            let moved = |by: f64| {
                let mut values = values.to_vec();
                values[k] = (values[k] + by).clamp(unknowns[k].low, unknowns[k].high);
                (values[k], residuals(&values))
            };
            let (x1, above) = moved(unknowns[k].step);
            let (x0, below) = if unknowns[k].linear && x1 > values[k] {
                (values[k], residuals_here.clone())
            } else {
                moved(-unknowns[k].step)
            };
            let scale = 1.0 / (x1 - x0);
            let channel = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| (a - b) * scale).collect();
            above.iter().zip(&below).map(channel).collect::<Vec<Vec<f64>>>()
        };
        let slopes: Vec<_> = (0..values.len()).into_par_iter().map(slope).collect();
        let residuals = residuals_here;
        let product = |a: &[Vec<f64>], b: &[Vec<f64>]| -> f64 {
            let channel = |c: usize| (0..a[c].len()).map(|i| weights.of[c][i] * a[c][i] * b[c][i]).sum::<f64>();
            (0..a.len()).map(channel).sum()
        };
        let n = values.len();
        let normal = DMatrix::from_fn(n, n, |i, j| if i <= j { product(&slopes[i], &slopes[j]) } else { 0.0 });
        let normal = DMatrix::from_fn(n, n, |i, j| normal[(i.min(j), i.max(j))]);
        let gradient = DVector::from_fn(n, |i, _| product(&slopes[i], &residuals));
        let finite = normal.iter().chain(gradient.iter()).all(|x| x.is_finite());
        finite.then_some(System { weights, residuals, slopes, normal, gradient })
    }

    /// The unknowns that may move: not at a bound that the descent pushes against, and with any effect at all.
    fn free(&self, unknowns: &[Unknown], values: &[f64]) -> Vec<usize> {
        let blocked = |i: usize| {
            let (u, x, downhill) = (&unknowns[i], values[i], -self.gradient[i]);
            x <= u.low && downhill <= 0.0 || x >= u.high && downhill >= 0.0
        };
        (0..values.len()).filter(|&i| !blocked(i) && self.normal[(i, i)] > 0.0).collect()
    }

    fn part(&self, free: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(free.len(), free.len(), |i, j| self.normal[(free[i], free[j])])
    }

    /// Covariance by leaving out one block after the other (the cluster jackknife, CR3): how far the values would move without
    /// a block is (H - H_b)^-1 U_b, with H the normal equations and U the gradient. Unlike the sum of U U' alone it stays honest where
    /// few blocks, such as the few yaw steps of a flight, hold most of what is known.
    fn jackknife(&self, unknowns: &[Unknown], values: &[f64], blocks: &[u32]) -> Option<(DMatrix<f64>, Vec<bool>)> {
        let free = self.free(unknowns, values);
        let n = free.len();
        let mut shares: BTreeMap<u32, (DMatrix<f64>, DVector<f64>)> = BTreeMap::new();
        for (c, residuals) in self.residuals.iter().enumerate() {
            for (i, r) in residuals.iter().enumerate() {
                let (normal, gradient) =
                    shares.entry(blocks[i]).or_insert_with(|| (DMatrix::zeros(n, n), DVector::zeros(n)));
                for row in 0..n {
                    let weighted = self.weights.of[c][i] * self.slopes[free[row]][c][i];
                    gradient[row] += weighted * r;
                    for column in 0..=row {
                        normal[(row, column)] += weighted * self.slopes[free[column]][c][i];
                    }
                }
            }
        }
        let whole = self.part(&free);
        let everything = scaled_inverse(whole.clone())?;
        let mut inner = DMatrix::zeros(n, n);
        for (normal, gradient) in shares.values() {
            let rest = DMatrix::from_fn(n, n, |i, j| whole[(i, j)] - normal[(i.max(j), i.min(j))]);
            // A block without which nothing can be told counts as it is.
            let moved = scaled_inverse(rest).unwrap_or_else(|| everything.clone()) * gradient;
            inner += &moved * moved.transpose();
        }
        let mut covariance = DMatrix::zeros(values.len(), values.len());
        for (row, &i) in free.iter().enumerate() {
            for (column, &j) in free.iter().enumerate() {
                covariance[(i, j)] = inner[(row, column)];
            }
        }
        let at_bound = (0..values.len()).map(|i| !free.contains(&i)).collect();
        Some((covariance, at_bound))
    }
}

/// Inverse of a symmetric positive matrix, by way of its correlation form: the unknowns differ in scale by orders.
fn scaled_inverse(matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = matrix.diagonal().map(|d| 1.0 / d.sqrt());
    if scale.iter().any(|s| !s.is_finite()) {
        return None;
    }
    let form = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] * scale[i] * scale[j]);
    let inverse = form.try_inverse()?;
    Some(DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| inverse[(i, j)] * scale[i] * scale[j]))
}

/// One Levenberg-Marquardt step within the bounds. Whether it was worth another.
fn descend(
    unknowns: &[Unknown],
    values: &mut Vec<f64>,
    damping: &mut f64,
    system: &System,
    residuals: &(dyn Fn(&[f64]) -> Vec<Vec<f64>> + Sync),
) -> bool {
    let cost = system.weights.cost(&system.residuals);
    let free = system.free(unknowns, values);
    while !free.is_empty() && *damping < 100.0 {
        let mut damped = system.part(&free);
        (0..free.len()).for_each(|i| damped[(i, i)] *= 1.0 + *damping);
        if let Some(inverse) = scaled_inverse(damped) {
            let step = -inverse * DVector::from_fn(free.len(), |i, _| system.gradient[free[i]]);
            let mut tried = values.clone();
            for (row, &i) in free.iter().enumerate() {
                tried[i] = (tried[i] + step[row]).clamp(unknowns[i].low, unknowns[i].high);
            }
            let lower = system.weights.cost(&residuals(&tried));
            if lower <= cost {
                *values = tried;
                *damping = (*damping * 0.1).max(1e-9);
                return cost - lower > ENOUGH * cost;
            }
        }
        *damping *= 10.0;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, Stream};
    use rand::RngExt;
    use rand_distr::StandardNormal;

    /// y = a exp(-t / b) with white noise and a few gross outliers.
    fn data(seed: u64) -> (Vec<f64>, Vec<f64>, Vec<u32>) {
        let mut rng = Philox::new(seed).sequence(Stream::Noise, 0, 0);
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
        for seed in 0..40 {
            let (t, y, blocks) = data(seed);
            let residuals =
                |x: &[f64]| vec![t.iter().zip(&y).map(|(t, y)| x[0] * (-t / x[1]).exp() - y).collect::<Vec<_>>()];
            let found = solve(&[unknown(1.0, 0.0, 10.0), unknown(0.2, 0.01, 5.0)], &blocks, &residuals).unwrap();
            assert!((found.values[0] - 3.0).abs() < 0.1 && (found.values[1] - 0.7).abs() < 0.03, "{:?}", found.values);
            inside += usize::from((found.values[0] - 3.0).abs() < found.half_width(0));
            inside += usize::from((found.values[1] - 0.7).abs() < found.half_width(1));
            assert!((found.noise[0] - 0.1).abs() < 0.01);
        }
        // 95 % of 80, within three standard deviations.
        assert!((70..=80).contains(&inside), "{inside}");
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
