//! Effects tried beside what stands: fitted with the base, each from all sizes that could be it.

use super::candidates::{Candidate, Direction};
use super::fit::{self, FitPoint};
use super::numbers::{place, span};
use super::problem::Problem;
use super::size::is_bounded;
use super::whiten::Whitener;
use crate::insight::criteria::evident::{
    BOUNDED_MERIT, EVIDENCE_WORTH_A_FIT, GAIN_WORTH_A_FIT, LEAST_GAIN, RARE_GAIN, SHORT_LIST,
};
use crate::insight::criteria::rival::TIE_DEVIATIONS;
use crate::model::effects::{Card, are_rivals};
use rayon::prelude::*;

/// An effect that was tried beside what stands.
pub struct Trial {
    pub card: &'static Card,
    pub point: FitPoint,
    /// Fall of the whitened squares.
    pub gain: f64,
}

impl Trial {
    /// Gain; less of it where a number ends at the bound of its range, for then the effect stands in for something
    /// else.
    pub fn merit(&self, problem: &Problem) -> f64 {
        if self.bounded(problem) { BOUNDED_MERIT.get() * self.gain } else { self.gain }
    }

    pub fn bounded(&self, problem: &Problem) -> bool {
        is_bounded(problem, self.card, &self.point.x)
    }
}

/// Whether a trial comes so near the best that their stretches of time do not decide.
pub fn tied(best: &Trial, other: &Trial) -> bool {
    let differences: Vec<f64> = other.point.cost.iter().zip(&best.point.cost).map(|(a, b)| a - b).collect();
    let sum: f64 = differences.iter().sum();
    let spread = differences.iter().map(|d| d * d).sum::<f64>().sqrt();
    other.gain > LEAST_GAIN.get() && sum < TIE_DEVIATIONS.get() * spread
}

/// Refits the first of the ranking, and the rivals of the very first.
pub fn try_best(
    problem: &Problem,
    whitener: &Whitener,
    point: &FitPoint,
    found: &[Candidate],
    order: &[(usize, f64, f64)],
) -> Vec<Trial> {
    try_these(problem, whitener, point, found, &chosen(found, order))
}

/// Refits candidates, each of an effect of its own.
pub fn try_these(
    problem: &Problem,
    whitener: &Whitener,
    point: &FitPoint,
    found: &[Candidate],
    which: &[usize],
) -> Vec<Trial> {
    let trials = Trials { problem, whitener, point, found };
    which.par_iter().map(|&j| trials.best(j)).collect()
}

/// The candidates that are worth a fit, best first; one direction of each effect.
fn chosen(found: &[Candidate], order: &[(usize, f64, f64)]) -> Vec<usize> {
    let mut chosen: Vec<usize> = Vec::new();
    for &(j, gain, evidence) in order {
        let card = found[j].card();
        let known = chosen.iter().any(|&i| found[i].card().id == card.id);
        let leader = chosen.first().map(|&i| found[i].card());
        let rival = leader.is_some_and(|l| are_rivals(l, card));
        let often = evidence > EVIDENCE_WORTH_A_FIT.get();
        let evident = gain > GAIN_WORTH_A_FIT.get() && (often || gain > RARE_GAIN.get());
        if !known && evident && (chosen.len() < SHORT_LIST.count() || rival) {
            chosen.push(j);
        }
    }
    chosen
}

/// What effects are tried beside.
struct Trials<'a> {
    problem: &'a Problem,
    whitener: &'a Whitener,
    point: &'a FitPoint,
    found: &'a [Candidate],
}

impl Trials<'_> {
    /// The effect of candidate `j`, fitted from wherever it ends best.
    fn best(&self, j: usize) -> Trial {
        let Direction { card, start } = &self.found[j].direction;
        let x = &self.point.x;
        let before = self.point.total();
        let mut best = self.fitted(x, card, start, 1.0);
        if best.total() > before {
            // Too far away: from a size too small to matter, downhill.
            best = self.fitted(x, card, start, 0.2 * card.parameters[0].typical[0] / start[0].1.abs());
        }
        if card.parameters[0].unit == "s" {
            // Late signals fit at more than one delay.
            let directions =
                || self.found.iter().map(|c| &c.direction).enumerate().filter(|(_, d)| d.card.id == card.id);
            let others = directions().filter(|(i, _)| *i != j).map(|(_, d)| self.fitted(x, card, &d.start, 1.0));
            let beside = directions().filter(|_| !card.absorbed_by.is_empty());
            let beside = beside.map(|(_, d)| self.fitted(&self.shortened(card, d.start[0].1), card, &d.start, 1.0));
            for another in others.chain(beside) {
                if another.total() < best.total() {
                    best = another;
                }
            }
        }
        let gain = before - best.total();
        Trial { card, point: best, gain }
    }

    /// FittedSelection from the numbers `x` with the effect at `shrink` times the sizes `start`.
    fn fitted(&self, x: &[f64], card: &Card, start: &[(usize, f64)], shrink: f64) -> FitPoint {
        let own: Vec<usize> = span(card).collect();
        let mut x = x.to_vec();
        own.iter().for_each(|&k| x[k] = 0.0);
        start.iter().for_each(|(k, value)| x[*k] = value * shrink);
        fit::refit(self.problem, self.whitener, self.point, &own, &x)
    }

    /// The point's numbers, with the time constants that a delay is mistaken for shorter by it: a lag that was fitted
    /// without its delay is too long by about that.
    fn shortened(&self, card: &Card, delay: f64) -> Vec<f64> {
        let mut x = self.point.x.clone();
        let numbers = &self.problem.model.numbers;
        let absorbing = card.absorbed_by.iter().flat_map(|number| place(*number));
        absorbing.for_each(|k| x[k] = (x[k] - delay).max(0.3 * x[k]).max(numbers[k].low));
        x
    }
}
