//! Fitting numbers of the model to all flights: Gauss-Newton on whitened residuals, with derivatives that are used more than once.

use super::gram::{Grams, inverse};
use super::predict::CHANNELS;
use super::problem::{ChannelValues, Predictions, Problem};
use super::whiten::Whitener;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Steps with the same derivatives, and how often these are renewed.
const CHORDS: usize = 4;
const RENEWALS: usize = 3;
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
                let Some(step) = step(problem, &gram, &white.iter().collect::<Vec<_>>(), &whitened, &x, free) else {
                    break;
                };
                let Some(next) = descend(problem, whitener, (&state, &x), free, &step, cost.iter().sum()) else {
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

/// The Gauss-Newton step; numbers at a bound that they push against stay.
fn step(
    problem: &Problem,
    gram: &DMatrix<f64>,
    white: &[&ChannelValues],
    residual: &ChannelValues,
    x: &[f64],
    free: &[usize],
) -> Option<Vec<f64>> {
    let prior = prior(problem, free);
    let right: Vec<f64> = (0..free.len())
        .map(|j| {
            let along: f64 =
                (0..CHANNELS).map(|c| white[j][c].iter().zip(&residual[c]).map(|(a, b)| a * b).sum::<f64>()).sum();
            along - prior[j] * (x[free[j]] - problem.model.base[free[j]])
        })
        .collect();
    let mut moving: Vec<usize> = (0..free.len()).collect();
    for _ in 0..3 {
        let inner =
            inverse(&Grams::pick(gram, &moving, &moving), &moving.iter().map(|&j| prior[j]).collect::<Vec<_>>())?;
        let step = inner * DVector::from_iterator(moving.len(), moving.iter().map(|&j| right[j]));
        let stuck = |a: usize| {
            let (k, by) = (free[moving[a]], step[a]);
            let n = &problem.model.numbers[k];
            x[k] <= n.low && by < 0.0 || x[k] >= n.high && by > 0.0
        };
        let still: Vec<usize> = (0..moving.len()).filter(|&a| !stuck(a)).map(|a| moving[a]).collect();
        if still.len() == moving.len() {
            let mut out = vec![0.0; free.len()];
            moving.iter().enumerate().for_each(|(a, &j)| out[j] = step[a]);
            return Some(out);
        }
        moving = still;
    }
    None
}

/// The point a step away, halved until it is better; none where no part of the step is.
fn descend(
    problem: &Problem,
    whitener: &Whitener,
    from: (&Predictions, &[f64]),
    free: &[usize],
    step: &[f64],
    before: f64,
) -> Option<FitPoint> {
    let (old, x) = from;
    let before = before + penalty(problem, free, x);
    for halving in 0..5 {
        let share = 0.5f64.powi(halving);
        let mut next = x.to_vec();
        for (&k, by) in free.iter().zip(step) {
            let n = &problem.model.numbers[k];
            next[k] = (x[k] + share * by).clamp(n.low, n.high);
        }
        let moved: Vec<usize> = free.iter().copied().filter(|&k| next[k] != x[k]).collect();
        let state = problem.change(old, &moved, &next);
        let residual = problem.residuals(&state);
        let cost = costs(problem, &whitener.apply(&residual, &problem.rows));
        if cost.iter().sum::<f64>() + penalty(problem, free, &next) < before {
            return Some(FitPoint { x: next, state, free: Vec::new(), white: Vec::new(), residual, cost });
        }
    }
    None
}

/// Fits `point` with the numbers `own` beside its own, from `x`; the derivatives of the point's own numbers are taken as they are there.
pub fn refit(problem: &Problem, whitener: &Whitener, point: &FitPoint, own: &[usize], x: &[f64]) -> FitPoint {
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
    for _ in 0..CHORDS + 2 {
        let mine = whitened_slopes(problem, whitener, &at.state, &at.x, own);
        let white: Vec<&ChannelValues> = kept.iter().map(|&j| &point.white[j]).chain(&mine).collect();
        let gram = Grams::new(&white, &problem.rows, problem.blocks).sum;
        let whitened = whitener.apply(&at.residual, &problem.rows);
        let Some(step) = step(problem, &gram, &white, &whitened, &at.x, &free) else { break };
        let Some(next) = descend(problem, whitener, (&at.state, &at.x), &free, &step, at.total()) else { break };
        let gained = at.total() - next.total();
        at = next;
        if gained < 1.0 {
            break;
        }
    }
    at.free = point.free.iter().chain(own).copied().collect();
    at
}

/// Stretches of time that are also left out together, and the least number of such groups that tells anything: what is wrong for longer than a
/// stretch is no new evidence in the next.
const GROUP: usize = 5;
const GROUPS: usize = 20;

/// Covariance of the fitted numbers of `point` by leaving out one stretch of time after the other (the cluster jackknife, CR3); wider where leaving out
/// longer ones says so.
pub fn covariance(problem: &Problem, whitener: &Whitener, point: &FitPoint) -> Option<DMatrix<f64>> {
    let n = point.free.len();
    let residual = whitener.apply(&point.residual, &problem.rows);
    let columns: Vec<&ChannelValues> = point.white.iter().chain([&residual]).collect();
    let grams = Grams::new(&columns, &problem.rows, problem.blocks);
    let prior = prior(problem, &point.free);
    let own: Vec<usize> = (0..n).collect();
    let whole = Grams::pick(&grams.sum, &own, &own);
    let everything = inverse(&whole, &prior)?;
    let moved = |group: &[DMatrix<f64>]| {
        let out = group.iter().fold(DMatrix::zeros(n + 1, n + 1), |sum, gram| sum + gram);
        let u = Grams::pick(&out, &own, &[n]).column(0).into_owned();
        (out[(n, n)] > 0.0)
            .then(|| inverse(&(&whole - Grams::pick(&out, &own, &own)), &prior).unwrap_or(everything.clone()) * u)
    };
    let jackknife = |size: usize| {
        let moves: Vec<DVector<f64>> = grams.blocks.par_chunks(size).filter_map(moved).collect();
        let spread = moves.iter().fold(DMatrix::zeros(n, n), |sum, moved| sum + moved * moved.transpose());
        (spread, moves.len())
    };
    let (single, _) = jackknife(1);
    let (grouped, count) = jackknife(GROUP);
    if count < GROUPS {
        return Some(single);
    }
    let wider = |i: usize| (grouped[(i, i)] / single[(i, i)].max(1e-300)).max(1.0).sqrt();
    let scale: Vec<f64> = (0..n).map(wider).collect();
    Some(DMatrix::from_fn(n, n, |i, j| single[(i, j)] * scale[i] * scale[j]))
}
