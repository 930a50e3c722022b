//! Directions in the order of what they would explain.

use super::candidates::Candidate;
use crate::insight::criteria::flown::ABSORBED_SHARE;
use crate::insight::diagnose::fitting::fit::FitPoint;
use crate::insight::diagnose::fitting::score::{ScoreTest, score};
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::insight::estimate::gram::Grams;
use rayon::prelude::*;

/// Directions beside what is fitted.
pub struct Ranking {
    /// Directions by the expected fall of the whitened squares, the best first, with that and the stretches of time
    /// that agree.
    pub order: Vec<(usize, f64, f64)>,
    /// The score of each direction.
    pub scores: Vec<Option<ScoreTest>>,
    /// Inner products of the fitted columns, the directions' and the residual, with the priors.
    grams: Grams,
    prior: Vec<f64>,
}

impl Ranking {
    /// The score of direction `j` beside direction `i`.
    pub fn beside(&self, j: usize, i: usize) -> Option<ScoreTest> {
        let residual = self.prior.len() - 1;
        let n = residual - self.scores.len();
        let rest: Vec<usize> = (0..n).chain([n + i]).collect();
        score(&self.grams, &rest, &[n + j], residual, &self.prior)
    }
}

/// Ranks the directions `found`.
pub fn rank(problem: &Problem, whitener: &Whitener, point: &FitPoint, found: &[Candidate]) -> Ranking {
    let residual = whitener.apply(&point.residual, &problem.rows);
    let n = point.white.len();
    let all: Vec<&ChannelValues> =
        point.white.iter().chain(found.iter().map(|c| &c.white)).chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let rest: Vec<usize> = (0..n).collect();
    let mut prior: Vec<f64> = point.free.iter().map(|&k| problem.model.numbers[k].trust.powi(-2)).collect();
    prior.resize(all.len(), 0.0);
    let scores: Vec<_> =
        (0..found.len()).into_par_iter().map(|j| score(&grams, &rest, &[n + j], all.len() - 1, &prior)).collect();
    let mut order: Vec<(usize, f64, f64)> = Vec::new();
    for (j, s) in scores.iter().enumerate() {
        if let Some(s) = s
            && s.information[0] > ABSORBED_SHARE.get() * s.raw[0]
        {
            order.push((j, s.gain, s.evidence));
        }
    }
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    Ranking { order, scores, grams, prior }
}
