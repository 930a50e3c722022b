//! Fitting numbers of the model to all flights: Gauss-Newton on whitened residuals, with derivatives that are used more
//! than once.

use super::whiten::Whitener;
use crate::insight::diagnose::prediction::channels::CHANNELS;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Predictions, Problem};
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::jackknife::jackknife;
use crate::insight::estimate::least_squares::{Bounded, Normal, Shorter};
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::sync::Arc;

/// Steps with the same derivatives, and how often these are renewed.
const CHORDS: usize = 4;
const RENEWALS: usize = 3;
/// A step that lowers the whitened squares by less than this ends the fit, and that of one that is only tried.
const ENOUGH: f64 = 0.05;
const ENOUGH_TRIED: f64 = 1.0;

/// Where a fit stands, with everything linear about it.
#[derive(Clone, Default)]
pub struct FitPoint {
    pub x: Vec<f64>,
    pub state: Predictions,
    /// Numbers that are fitted.
    pub free: Vec<usize>,
    /// Change of the prediction by each of them, as it is and whitened.
    pub slopes: Arc<Vec<ChannelValues>>,
    pub white: Vec<ChannelValues>,
    /// Measured less predicted.
    pub residual: ChannelValues,
    /// Whitened squares of each stretch of time.
    pub cost: Vec<f64>,
}

impl FitPoint {
    /// The point `x`, whose prediction is `state`, with nothing linear about it.
    fn new(problem: &Problem, whitener: &Whitener, x: Vec<f64>, state: Predictions) -> Self {
        let residual = problem.residuals(&state);
        let cost = costs(problem, &whitener.apply(&residual, &problem.rows));
        Self { x, state, free: Vec::new(), slopes: Arc::default(), white: Vec::new(), residual, cost }
    }

    /// The same with what is linear about the numbers `free`: their slopes, where those are known.
    fn linear(
        self,
        problem: &Problem,
        whitener: &Whitener,
        free: &[usize],
        known: Option<&Arc<Vec<ChannelValues>>>,
    ) -> Self {
        let slopes = known.cloned().unwrap_or_else(|| problem.slopes(&self.state, &self.x, free).into());
        let white = slopes.par_iter().map(|slope| whitener.apply(slope, &problem.rows)).collect();
        Self { free: free.to_vec(), slopes, white, ..self }
    }

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
    descended(problem, whitener, stay(problem, whitener, x, free))
}

/// Fits the numbers of `point` but those `dropped`, which are as the base vehicle has them.
pub fn fit_without(problem: &Problem, whitener: &Whitener, point: &FitPoint, dropped: &[usize]) -> FitPoint {
    if dropped.is_empty() {
        return point.clone();
    }
    let mut x = point.x.clone();
    dropped.iter().for_each(|&k| x[k] = problem.model.base[k]);
    let free: Vec<usize> = point.free.iter().copied().filter(|k| !dropped.contains(k)).collect();
    fit(problem, whitener, &x, &free)
}

/// Fits the numbers of `point` once more, by another whitener.
pub fn again(problem: &Problem, whitener: &Whitener, point: &FitPoint) -> FitPoint {
    descended(problem, whitener, stay_again(problem, whitener, point))
}

/// The point `x` as it is, with what is linear about the numbers `free`.
pub fn stay(problem: &Problem, whitener: &Whitener, x: &[f64], free: &[usize]) -> FitPoint {
    FitPoint::new(problem, whitener, x.to_vec(), problem.predict(x)).linear(problem, whitener, free, None)
}

/// The point as it is, by another whitener.
pub fn stay_again(problem: &Problem, whitener: &Whitener, point: &FitPoint) -> FitPoint {
    let same = FitPoint::new(problem, whitener, point.x.clone(), point.state.clone());
    same.linear(problem, whitener, &point.free, Some(&point.slopes))
}

/// The fit of a point's numbers from where it stands.
fn descended(problem: &Problem, whitener: &Whitener, mut at: FitPoint) -> FitPoint {
    for _ in 0..RENEWALS {
        let white: Vec<&ChannelValues> = at.white.iter().collect();
        let gram = Grams::new(&white, &problem.rows, problem.blocks.max(1)).sum;
        let mut next: Option<FitPoint> = None;
        let mut moved = false;
        for _ in 0..CHORDS {
            let from = next.as_ref().unwrap_or(&at);
            let whitened = whitener.apply(&from.residual, &problem.rows);
            let normal = normal(problem, &gram, &white, &whitened, &from.x, &at.free);
            let Some(lower) =
                descend(problem, whitener, (&from.state, &from.x), &at.free, &normal, (from.total(), ENOUGH))
            else {
                break;
            };
            let gained = from.total() - lower.total();
            next = Some(lower);
            moved |= gained > ENOUGH;
            if gained < ENOUGH {
                break;
            }
        }
        if let Some(next) = next {
            at = if moved {
                next.linear(problem, whitener, &at.free, None)
            } else {
                FitPoint { free: at.free, slopes: at.slopes, white: at.white, ..next }
            };
        }
        if !moved {
            break;
        }
    }
    at
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

/// The point a step away, or a part of it, that lowers the squares `before`; none where none does, or the step should
/// by less than `least`.
fn descend(
    problem: &Problem,
    whitener: &Whitener,
    from: (&Predictions, &[f64]),
    free: &[usize],
    normal: &Normal,
    (before, least): (f64, f64),
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
        let point = FitPoint::new(problem, whitener, next, state);
        (point.total() + penalty(problem, free, &point.x), point)
    };
    let before = before + penalty(problem, free, x);
    // Differences of two sets stand in for one another, and for what both have.
    let shorter = if problem.contrast.is_some() { Shorter::Seldom(least) } else { Shorter::Halved(least) };
    normal.descend(&at, shorter, before, squares).map(|(_, _, point)| point)
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
    let mut at = FitPoint::new(problem, whitener, x.to_vec(), problem.change(&point.state, &moved, x));
    for _ in 0..steps {
        let mine = whitened_slopes(problem, whitener, &at.state, &at.x, own);
        let white: Vec<&ChannelValues> = kept.iter().map(|&j| &point.white[j]).chain(&mine).collect();
        let gram = Grams::new(&white, &problem.rows, problem.blocks).sum;
        let whitened = whitener.apply(&at.residual, &problem.rows);
        let normal = normal(problem, &gram, &white, &whitened, &at.x, &free);
        let Some(next) = descend(problem, whitener, (&at.state, &at.x), &free, &normal, (at.total(), ENOUGH_TRIED))
        else {
            break;
        };
        let gained = at.total() - next.total();
        at = next;
        if gained < ENOUGH_TRIED {
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
