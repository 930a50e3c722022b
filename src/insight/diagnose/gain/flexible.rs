//! What could be gained at most: a regression that knows nothing of vehicles, on the signals that the simulation knows,
//! fitted to what the extended model leaves on one part of the flight and judged on the other.
//!
//! Ridge regression on random Fourier features (Rahimi and Recht, "Random Features for Large-Scale Kernel Machines",
//! NIPS 2007), which approximates a Gaussian process. No library: it stands on `estimate` and takes a hundred lines.

use crate::base::rng::{Philox, RngStream};
use crate::base::stats::{mean, sd};
use crate::insight::criteria::flown::HELD_OUT_ROWS;
use crate::insight::diagnose::fitting::fit::FitPoint;
use crate::insight::diagnose::prediction::channels::CHANNELS;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::insight::diagnose::prediction::signals::signals;
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_distr::StandardNormal;
use rayon::prelude::*;

/// Waves of the signals, beside the signals themselves.
const WAVES: usize = 160;
/// Rows of a channel that are learned from at most; more say the same again.
const MOST_ROWS: usize = 6000;
/// Signals are alike within so many standard deviations, times the root of their number.
const WIDTH: f64 = 1.0;
/// Ridges, as shares of the rows, of which a part of the learned stretches chooses: every so many.
const TRIED_OF: usize = 4;
const RIDGES: [f64; 4] = [1e-3, 1e-2, 1e-1, 1.0];

/// The residual of `point` without what the regression predicts of it, which was fitted where nothing is `out`.
pub fn corrected(problem: &Problem, point: &FitPoint, out: &[bool]) -> ChannelValues {
    let all: Vec<Vec<f64>> = (0..CHANNELS).into_par_iter().map(|c| channel(problem, point, out, c)).collect();
    all.try_into().expect("as many as there are channels")
}

fn channel(problem: &Problem, point: &FitPoint, out: &[bool], c: usize) -> Vec<f64> {
    let residual = &point.residual[c];
    let block = |i: usize| problem.rows[c][i].block as usize;
    let known: Vec<usize> = (0..residual.len()).filter(|&i| !out[block(i)]).collect();
    if known.len() < HELD_OUT_ROWS.count() {
        return residual.clone();
    }
    let features = Features::new(problem, point, c);
    let learned: Vec<usize> = known.iter().copied().step_by(known.len().div_ceil(MOST_ROWS)).collect();
    let is_tried = |i: &usize| block(*i) % TRIED_OF == 0;
    let (tried, fitted): (Vec<usize>, Vec<usize>) = learned.iter().copied().partition(is_tried);
    let ridge = |ridge: &f64, rows: &[usize]| features.fit(residual, rows, *ridge);
    let left = |weights: &DVector<f64>| -> f64 {
        tried.iter().map(|&i| (residual[i] - features.row(i).dot(weights)).powi(2)).sum()
    };
    let nothing: f64 = tried.iter().map(|&i| residual[i].powi(2)).sum();
    let errors = RIDGES.iter().filter_map(|r| Some((r, left(&ridge(r, &fitted)?))));
    let best = errors.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, left)| *left < nothing);
    match best.and_then(|(r, _)| ridge(r, &learned)) {
        Some(weights) => (0..residual.len()).map(|i| residual[i] - features.row(i).dot(&weights)).collect(),
        None => residual.clone(),
    }
}

/// The features of a channel's rows.
struct Features {
    /// Signals, standardised.
    signals: Vec<Vec<f64>>,
    /// Frequencies of each feature by signal, and its phase.
    waves: Vec<(Vec<f64>, f64)>,
}

impl Features {
    fn new(problem: &Problem, point: &FitPoint, c: usize) -> Self {
        let standard = |(_, _, signal): (&str, &str, Vec<f64>)| {
            let (middle, spread) = (mean(&signal), sd(&signal)?);
            (spread > 0.0 && spread.is_finite()).then(|| signal.iter().map(|s| (s - middle) / spread).collect())
        };
        let signals: Vec<Vec<f64>> = signals(problem, &point.state, c).into_iter().filter_map(standard).collect();
        let mut random = Philox::new(0).sequence(RngStream::Features, c as u32, 0);
        let scale = 1.0 / (WIDTH * (signals.len().max(1) as f64).sqrt());
        let mut wave = || {
            let frequencies = signals.iter().map(|_| scale * random.sample::<f64, _>(StandardNormal)).collect();
            (frequencies, random.uniform([0.0, std::f64::consts::TAU]))
        };
        let waves = (0..WAVES).map(|_| wave()).collect();
        Self { signals, waves }
    }

    /// One, the signals, and the waves of them.
    fn row(&self, i: usize) -> DVector<f64> {
        let at = |s: &Vec<f64>| s[i];
        let wave = |(frequencies, phase): &(Vec<f64>, f64)| {
            (frequencies.iter().zip(&self.signals).map(|(f, s)| f * s[i]).sum::<f64>() + phase).cos()
        };
        let all = std::iter::once(1.0).chain(self.signals.iter().map(at)).chain(self.waves.iter().map(wave));
        DVector::from_iterator(1 + self.signals.len() + self.waves.len(), all)
    }

    /// Weights of the features for `residual` at `rows`.
    fn fit(&self, residual: &[f64], rows: &[usize], ridge: f64) -> Option<DVector<f64>> {
        let n = 1 + self.signals.len() + self.waves.len();
        let mut matrix = DMatrix::zeros(n, rows.len());
        rows.iter().enumerate().for_each(|(j, &i)| matrix.set_column(j, &self.row(i)));
        let target = DVector::from_iterator(rows.len(), rows.iter().map(|&i| residual[i]));
        let mut square = &matrix * matrix.transpose();
        (0..n).for_each(|k| square[(k, k)] += ridge * rows.len() as f64);
        Some(square.cholesky()?.solve(&(matrix * target)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bend_of_two_signals_is_learned_and_noise_is_not() {
        let mut random = Philox::new(1).sequence(RngStream::Features, 0, 0);
        let mut normal = |n: usize| -> Vec<f64> { (0..n).map(|_| random.sample(StandardNormal)).collect() };
        let signals = vec![normal(3000), normal(3000)];
        let (noise, phases) = (normal(3000), normal(WAVES));
        let frequencies = (0..WAVES).map(|_| normal(2)).collect::<Vec<_>>();
        let waves = frequencies.into_iter().zip(phases).collect();
        let features = Features { signals, waves };
        let bent = |i: usize| (features.signals[0][i] * features.signals[1][i]).tanh() + 0.1 * noise[i];
        let target: Vec<f64> = (0..3000).map(bent).collect();
        let rows: Vec<usize> = (0..2000).collect();
        let left = |target: &[f64]| {
            let weights = features.fit(target, &rows, 1e-3).expect("a ridge");
            let off = |i: usize| (target[i] - features.row(i).dot(&weights)).powi(2);
            (2000..3000).map(off).sum::<f64>() / (2000..3000).map(|i| target[i].powi(2)).sum::<f64>()
        };
        assert!(left(&target) < 0.1, "{}", left(&target));
        assert!(left(&noise) > 0.95, "{}", left(&noise));
    }
}
