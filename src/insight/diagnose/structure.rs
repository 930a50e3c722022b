//! Is anything left? What of a residual an additive model of many signals predicts on stretches of time that it has not
//! seen, with what that lines up with; and how much of it its own past predicts.

pub mod folds;
pub mod oscillation;
pub mod place;
pub mod pushes;

use crate::base::stats::quantile;
use crate::insight::criteria::complete::VARIANCE_SHARE;
use crate::insight::criteria::flown::STRUCTURE_ROWS;
use crate::insight::diagnose::prediction::channels::{FORCE, NAMES, RATE, VOLTAGE};
use crate::insight::diagnose::prediction::problem::{ChannelValues, Predictions, Problem};
use crate::insight::diagnose::prediction::signals::signals;
use crate::insight::estimate::autoregression::autoregression;
use crate::insight::estimate::robust::capped;
use folds::{FOLDS, fold};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::Serialize;

/// Levels that a signal is cut into.
const BINS: usize = 8;
/// Residuals are capped at so many standard deviations.
const CAP: f64 = 5.0;
/// Values before a residual that may tell it.
const MEMORY: usize = 6;

/// A signal that the simulation knows: no measurement that enters the residual is among them.
pub struct Feature {
    pub name: &'static str,
    /// Level of each row, 0 to [`BINS`].
    level: Vec<u8>,
    /// Upper ends of the levels.
    pub edges: Vec<f64>,
}

/// Structure in one channel.
#[derive(Clone, Debug, Serialize)]
pub struct Structure {
    pub channel: &'static str,
    pub unit: &'static str,
    /// Root mean square of the residual, of what of it is structure in the mean, and of what its own past predicts.
    pub rms: f64,
    pub structure_rms: f64,
    pub coloured_rms: f64,
    /// The signal that explains most of it, with the share that it explains, and the curve: level of the signal, mean
    /// residual, its standard error.
    pub along: Option<&'static str>,
    pub along_share: f64,
    pub curve: Vec<[f64; 3]>,
    /// The signal that explains most of the variance, and the ratio of the standard deviations at its extremes.
    pub variance_along: Option<&'static str>,
    pub variance_ratio: f64,
}

/// The residuals of channels of rates, forces and voltage, searched for structure.
pub fn search(problem: &Problem, state: &Predictions, residual: &ChannelValues) -> Vec<Structure> {
    let channels: Vec<usize> =
        (RATE..FORCE + 3).chain([VOLTAGE]).filter(|&c| residual[c].len() > STRUCTURE_ROWS.count()).collect();
    let mut found: Vec<Structure> = channels.into_par_iter().map(|c| one(problem, state, c, &residual[c])).collect();
    let mut belongs = |c: usize, share: f64, along: &'static str| {
        found.iter_mut().filter(|s| s.channel == NAMES[c].0).for_each(|s| s.belongs(share, along));
    };
    if let Some(share) = place::share(problem, residual) {
        [FORCE, FORCE + 1].into_iter().for_each(|c| belongs(c, share, PLACE));
    }
    for swing in oscillation::find(problem, residual) {
        belongs(FORCE + swing.axis, swing.share, swing.name);
    }
    found
}

/// Where in the world it is, as a signal that structure lines up with.
pub const PLACE: &str = "place";

impl Structure {
    /// So much of the residual's power belongs to what no signal of the moment tells.
    fn belongs(&mut self, share: f64, along: &'static str) {
        self.structure_rms = self.structure_rms.max(share.sqrt() * self.rms);
        if share > self.along_share {
            (self.along, self.along_share, self.curve) = (Some(along), share, Vec::new());
        }
    }
}

fn one(problem: &Problem, state: &Predictions, c: usize, residual: &[f64]) -> Structure {
    let features = features(problem, state, c);
    let fold: Vec<u32> = problem.rows[c].iter().map(|row| fold(row.block)).collect();
    let y = capped(residual, CAP, 1e-12);
    let coloured = autoregression(&y, |i| problem.rows[c][i].follows, MEMORY);
    let power = crate::base::stats::mean(&y.iter().map(|y| y * y).collect::<Vec<_>>());
    let all: Vec<&Feature> = features.iter().collect();
    // A shifted residual has the same colour and no structure: what it seems to have is chance.
    let shifted = |by: usize| -> Vec<f64> { (0..y.len()).map(|i| y[(i + by) % y.len()]).collect() };
    let chance: Vec<f64> = (1..=4).map(|k| explained(&all, &shifted(k * y.len() / 5), &fold)).collect();
    let most = chance.iter().copied().fold(0.0, f64::max);
    let share = (explained(&all, &y, &fold) - most).max(0.0);
    let best = |y: &[f64]| {
        let shares = features.iter().map(|f| (explained(&[f], y, &fold), f));
        shares.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (along_share, along) = best(&y).map_or((0.0, None), |(s, f)| (s.max(0.0), (s > 0.0).then_some(f)));
    let logs: Vec<f64> = y.iter().map(|y| (y * y + 1e-3 * power).ln()).collect();
    let middle = crate::base::stats::mean(&logs);
    let logs: Vec<f64> = logs.iter().map(|l| l - middle).collect();
    let loud = best(&logs).and_then(|(s, f)| (s > VARIANCE_SHARE.get()).then_some(f));
    let spread = |f: &Feature| {
        let sd: Vec<f64> = curve(f, &y).iter().map(|[_, _, error]| *error).filter(|e| *e > 0.0).collect();
        let count = |f: &Feature, b: usize| f.level.iter().filter(|&&l| l as usize == b).count().max(1) as f64;
        let sds: Vec<f64> = sd.iter().enumerate().map(|(b, e)| e * count(f, b).sqrt()).collect();
        sds.iter().copied().fold(0.0, f64::max) / sds.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let (channel, unit) = NAMES[c];
    Structure {
        channel,
        unit,
        rms: crate::base::stats::mean(&residual.iter().map(|r| r * r).collect::<Vec<_>>()).sqrt(),
        structure_rms: (share * power).sqrt(),
        coloured_rms: (coloured.predicted * power).sqrt(),
        along: along.map(|f| f.name),
        along_share,
        curve: along.map_or(Vec::new(), |f| curve(f, &y)),
        variance_along: loud.map(|f| f.name),
        variance_ratio: loud.map_or(1.0, spread),
    }
}

/// Mean residual and its standard error by level of a signal.
fn curve(feature: &Feature, y: &[f64]) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]; feature.edges.len()];
    for (level, y) in feature.level.iter().zip(y) {
        let s = &mut sums[*level as usize];
        (s[0], s[1], s[2]) = (s[0] + 1.0, s[1] + y, s[2] + y * y);
    }
    let point = |(s, edge): (&[f64; 3], &f64)| {
        let n = s[0].max(1.0);
        let mean = s[1] / n;
        [*edge, mean, ((s[2] / n - mean * mean).max(0.0) / n).sqrt()]
    };
    sums.iter().zip(&feature.edges).map(point).collect()
}

/// Share of `y` that the levels of the features, added up, predict in folds that they were not fitted on.
fn explained(features: &[&Feature], y: &[f64], fold: &[u32]) -> f64 {
    let n = features.len() * BINS;
    let mut normal = vec![DMatrix::<f64>::zeros(n, n); FOLDS as usize];
    let mut right = vec![DVector::<f64>::zeros(n); FOLDS as usize];
    let mut active = vec![0usize; features.len()];
    for i in 0..y.len() {
        for (k, f) in features.iter().enumerate() {
            active[k] = k * BINS + f.level[i] as usize;
        }
        let (m, r) = (&mut normal[fold[i] as usize], &mut right[fold[i] as usize]);
        for (k, &a) in active.iter().enumerate() {
            r[a] += y[i];
            for &b in &active[..=k] {
                m[(a.max(b), a.min(b))] += 1.0;
            }
        }
    }
    let whole = normal.iter().fold(DMatrix::zeros(n, n), |s, m| s + m);
    let whole_right = right.iter().fold(DVector::zeros(n), |s, r| s + r);
    let ridge = 1e-3 * y.len() as f64;
    let solution: Vec<Option<DVector<f64>>> = (0..FOLDS as usize)
        .map(|k| {
            let rest = &whole - &normal[k];
            let full =
                DMatrix::from_fn(n, n, |i, j| rest[(i.max(j), i.min(j))] + if i == j { ridge + 1e-9 } else { 0.0 });
            full.cholesky().map(|c| c.solve(&(&whole_right - &right[k])))
        })
        .collect();
    let (mut left, mut total) = (0.0, 0.0);
    for i in 0..y.len() {
        let Some(beta) = &solution[fold[i] as usize] else { return 0.0 };
        let predicted: f64 = features.iter().enumerate().map(|(k, f)| beta[k * BINS + f.level[i] as usize]).sum();
        left += (y[i] - predicted).powi(2);
        total += y[i] * y[i];
    }
    1.0 - left / total.max(1e-300)
}

/// Signals at the rows of channel `c`, cut into levels.
fn features(problem: &Problem, state: &Predictions, c: usize) -> Vec<Feature> {
    let all = signals(problem, state, c);
    all.into_iter().filter_map(|(name, _, values)| Feature::new(name, &values)).collect()
}

impl Feature {
    /// Cuts a signal into levels that are equally often met; none where it hardly varies or is not known.
    fn new(name: &'static str, values: &[f64]) -> Option<Self> {
        let known: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        if known.len() < values.len() / 2 {
            return None;
        }
        let edges: Vec<f64> = (1..=BINS).map(|b| quantile(&known, b as f64 / BINS as f64)).collect();
        if edges[BINS - 1] - edges[0] < 1e-9 {
            return None;
        }
        let level = |v: &f64| edges.partition_point(|edge| edge < v).min(BINS - 1) as u8;
        Some(Feature { name, level: values.iter().map(level).collect(), edges })
    }
}
