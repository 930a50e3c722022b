//! Fitting numbers of the model to all flights: Gauss-Newton on whitened residuals, with derivatives that are used more
//! than once.

use super::channels::CHANNELS;
use super::problem::{ChannelValues, Predictions, Problem};
use super::whiten::Whitener;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::jackknife::jackknife;
use crate::insight::estimate::least_squares::{Bounded, Normal, Shorter};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Steps with the same derivatives, and how often these are renewed.
const CHORDS: usize = 4;
const RENEWALS: usize = 3;
/// Times that a step is halved.
const HALVINGS: i32 = 5;
/// A step that lowers the whitened squares by less than this ends the fit.
const ENOUGH: f64 = 0.05;

/// Where a fit stands, with everything linear about it.
#[derive(Clone)]
pub struct FitPoint {
    pub x: Vec<f64>,
    pub state: Predictions,
    /// Numbers that are fitted.
    pub free: Vec<usize>,
    /// Change of the prediction by each of them, whitened.
    pub white: Vec<ChannelValues>,
    /// Measured less predicted.
    pub residual: ChannelValues,
    /// Whitened squares of each stretch of time.
    pub cost: Vec<f64>,
}

impl FitPoint {
    pub fn total(&self) -> f64 {
        self.cost.iter().sum()
    }

    /// Inner products of the columns of the fitted numbers and of what is left, the last, by stretch of time.
    pub fn grams(&self, problem: &Problem, whitener: &Whitener) -> Grams {
        let residual = whitener.apply(&self.residual, &problem.rows);
        let columns: Vec<&ChannelValues> = self.white.iter().chain([&residual]).collect();
        Grams::new(&columns, &problem.rows, problem.blocks)
    }
}

/// Whitened squares by stretch of time.
pub fn costs(problem: &Problem, white: &ChannelValues) -> Vec<f64> {
    let mut out = vec![0.0; problem.blocks];
    for c in 0..CHANNELS {
        for (row, w) in problem.rows[c].iter().zip(&white[c]) {
            out[row.block as usize] += w * w;
        }
    }
    out
}

/// What moving away from the base vehicle costs.
fn prior(problem: &Problem, free: &[usize]) -> Vec<f64> {
    free.iter().map(|&k| problem.model.numbers[k].trust.powi(-2)).collect()
}

fn penalty(problem: &Problem, free: &[usize], x: &[f64]) -> f64 {
    free.iter().map(|&k| ((x[k] - problem.model.base[k]) / problem.model.numbers[k].trust).powi(2)).sum()
}

/// Fits the numbers `free`, starting from `x`.
pub fn fit(problem: &Problem, whitener: &Whitener, x: &[f64], free: &[usize]) -> FitPoint {
    let mut x = x.to_vec();
    let mut state = problem.predict(&x);
    let mut residual = problem.residuals(&state);
    let mut cost = costs(problem, &whitener.apply(&residual, &problem.rows));
    for renewal in 0..=RENEWALS {
        let white = whitened_slopes(problem, whitener, &state, &x, free);
        let mut moved = false;
        if renewal < RENEWALS {
            let gram = Grams::new(&white.iter().collect::<Vec<_>>(), &problem.rows, 1.max(problem.blocks)).sum;
            for _ in 0..CHORDS {
                let whitened = whitener.apply(&residual, &problem.rows);
                let normal = normal(problem, &gram, &white.iter().collect::<Vec<_>>(), &whitened, &x, free);
                let Some(next) = descend(problem, whitener, (&state, &x), free, &normal, cost.iter().sum()) else {
                    break;
                };
                let gained = cost.iter().sum::<f64>() - next.cost.iter().sum::<f64>();
                (x, state, residual, cost) = (next.x, next.state, next.residual, next.cost);
                moved |= gained > ENOUGH;
                if gained < ENOUGH {
                    break;
                }
            }
        }
        if !moved || renewal == RENEWALS {
            return FitPoint { x, state, free: free.to_vec(), white, residual, cost };
        }
    }
    unreachable!("the last renewal returns")
}

/// The point `x` as it is, with what is linear about the numbers `free`.
pub fn stay(problem: &Problem, whitener: &Whitener, x: &[f64], free: &[usize]) -> FitPoint {
    let state = problem.predict(x);
    let residual = problem.residuals(&state);
    let cost = costs(problem, &whitener.apply(&residual, &problem.rows));
    let white = whitened_slopes(problem, whitener, &state, x, free);
    FitPoint { x: x.to_vec(), state, free: free.to_vec(), white, residual, cost }
}

/// [`Problem::slopes`], whitened.
pub fn whitened_slopes(
    problem: &Problem,
    whitener: &Whitener,
    state: &Predictions,
    x: &[f64],
    which: &[usize],
) -> Vec<ChannelValues> {
    which.par_iter().map(|&k| whitener.apply(&problem.slope(state, x, k), &problem.rows)).collect()
}

/// The normal equations of the numbers `free` at `x`, from their columns and what is left, all whitened; `gram` is that
/// of the columns.
fn normal<'a>(
    problem: &Problem,
    gram: &'a DMatrix<f64>,
    white: &[&ChannelValues],
    left: &ChannelValues,
    x: &[f64],
    free: &[usize],
) -> Normal<'a> {
    let ridge = prior(problem, free);
    let along = |j: usize| -> f64 {
        let channel = |c: usize| white[j][c].iter().zip(&left[c]).map(|(a, b)| a * b).sum::<f64>();
        (0..CHANNELS).map(channel).sum()
    };
    let pull = |j: usize| ridge[j] * (x[free[j]] - problem.model.base[free[j]]);
    let downhill = (0..free.len()).map(|j| along(j) - pull(j)).collect();
    Normal { matrix: gram, downhill, ridge, within: &[] }
}

/// The point a step away, halved until it is better; none where no part of the step is.
fn descend(
    problem: &Problem,
    whitener: &Whitener,
    from: (&Predictions, &[f64]),
    free: &[usize],
    normal: &Normal,
    before: f64,
) -> Option<FitPoint> {
    let (old, x) = from;
    let numbers = &problem.model.numbers;
    let at: Vec<Bounded> =
        free.iter().map(|&k| Bounded { value: x[k], low: numbers[k].low, high: numbers[k].high }).collect();
    let squares = |values: &[f64]| {
        let mut next = x.to_vec();
        free.iter().zip(values).for_each(|(&k, value)| next[k] = *value);
        let moved: Vec<usize> = free.iter().copied().filter(|&k| next[k] != x[k]).collect();
        let state = problem.change(old, &moved, &next);
        let residual = problem.residuals(&state);
        let cost = costs(problem, &whitener.apply(&residual, &problem.rows));
        let total = cost.iter().sum::<f64>() + penalty(problem, free, &next);
        (total, FitPoint { x: next, state, free: Vec::new(), white: Vec::new(), residual, cost })
    };
    let before = before + penalty(problem, free, x);
    normal.descend(&at, Shorter::Halved(HALVINGS), before, squares).map(|(_, _, point)| point)
}

/// Fits `point` with the numbers `own` beside its own, from `x`; the derivatives of the point's own numbers are taken
/// as they are there.
pub fn refit(problem: &Problem, whitener: &Whitener, point: &FitPoint, own: &[usize], x: &[f64]) -> FitPoint {
    refit_in(CHORDS + 2, problem, whitener, point, own, x)
}

/// The same in no more than so many steps.
pub fn refit_in(
    steps: usize,
    problem: &Problem,
    whitener: &Whitener,
    point: &FitPoint,
    own: &[usize],
    x: &[f64],
) -> FitPoint {
    // Rates and forces hardly know of each other: what the numbers do not touch stays as it is.
    let all = || own.iter().map(|&k| &problem.model.numbers[k]);
    let (rates, forces) = (all().any(|n| n.rates), all().any(|n| n.forces));
    let touched = |k: &usize| {
        let n = &problem.model.numbers[*k];
        rates && n.rates || forces && n.forces
    };
    let kept: Vec<usize> = (0..point.free.len()).filter(|&j| touched(&point.free[j])).collect();
    let free: Vec<usize> = kept.iter().map(|&j| point.free[j]).chain(own.iter().copied()).collect();
    let moved: Vec<usize> = (0..x.len()).filter(|&k| x[k] != point.x[k]).collect();
    let state = problem.change(&point.state, &moved, x);
    let residual = problem.residuals(&state);
    let cost = costs(problem, &whitener.apply(&residual, &problem.rows));
    let mut at = FitPoint { x: x.to_vec(), state, free: Vec::new(), white: Vec::new(), residual, cost };
    for _ in 0..steps {
        let mine = whitened_slopes(problem, whitener, &at.state, &at.x, own);
        let white: Vec<&ChannelValues> = kept.iter().map(|&j| &point.white[j]).chain(&mine).collect();
        let gram = Grams::new(&white, &problem.rows, problem.blocks).sum;
        let whitened = whitener.apply(&at.residual, &problem.rows);
        let normal = normal(problem, &gram, &white, &whitened, &at.x, &free);
        let Some(next) = descend(problem, whitener, (&at.state, &at.x), &free, &normal, at.total()) else { break };
        let gained = at.total() - next.total();
        at = next;
        if gained < 1.0 {
            break;
        }
    }
    at.free = point.free.iter().chain(own).copied().collect();
    at
}

/// Stretches of time that are also left out together, and the least number of such groups that tells anything: what is
/// wrong for longer than a stretch is no new evidence in the next.
const GROUP: usize = 5;
const GROUPS: usize = 20;

/// Covariance of the fitted numbers of `point` by leaving out one stretch of time after the other; wider where leaving
/// out longer ones says so.
pub fn covariance(problem: &Problem, whitener: &Whitener, point: &FitPoint) -> Option<DMatrix<f64>> {
    let n = point.free.len();
    let grams = point.grams(problem, whitener);
    let prior = prior(problem, &point.free);
    let own: Vec<usize> = (0..n).collect();
    let (single, _) = jackknife(&grams, &own, n, &prior, 1)?;
    let (grouped, count) = jackknife(&grams, &own, n, &prior, GROUP)?;
    if count < GROUPS {
        return Some(single);
    }
    let wider = |i: usize| (grouped[(i, i)] / single[(i, i)].max(1e-300)).max(1.0).sqrt();
    let scale: Vec<f64> = (0..n).map(wider).collect();
    Some(DMatrix::from_fn(n, n, |i, j| single[(i, j)] * scale[i] * scale[j]))
}
