//! Effects tried beside what stands: fitted with the base, each from all sizes that could be it.

use super::candidates::{Candidate, Direction};
use crate::insight::criteria::evident::{
    BOUNDED_MERIT, EVIDENCE_WORTH_A_FIT, FORM_GAIN, FORM_TOLD, GAIN_WORTH_A_FIT, LEAST_GAIN, RARE_GAIN, SHORT_LIST,
};
use crate::insight::criteria::rival::TIE_DEVIATIONS;
use crate::insight::diagnose::fitting::agreement;
use crate::insight::diagnose::fitting::fit::{self, FitPoint};
use crate::insight::diagnose::fitting::size::is_bounded;
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::numbers::{place, span};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects::{Card, EffectKind, are_rivals};
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

    /// Whether it is an error of a sensor that attitude and velocity speak against: they agree with the sensors less
    /// than they do at `point`, without it.
    pub fn contradicted(&self, problem: &Problem, whitener: &Whitener, point: &FitPoint) -> bool {
        let apart = |at: &FitPoint| agreement::squares(problem, whitener, &at.residual);
        self.card.kind == EffectKind::Sensor && apart(&self.point) > apart(point) + LEAST_GAIN.get()
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

/// What a form has to gain beside an effect that gains so much.
pub fn form_gain(of_effect: f64) -> f64 {
    (FORM_GAIN.get() * of_effect).min(FORM_TOLD.get()).max(LEAST_GAIN.get())
}

/// Steps after which the best of several starts is known.
const GLANCE: usize = 2;

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
        let before = self.point.total();
        let mut starts = vec![self.start(&self.point.x, card, start, 1.0)];
        if card.parameters[0].unit == "s" {
            // Late signals fit at more than one delay.
            for (i, candidate) in self.found.iter().enumerate().filter(|(_, c)| c.card().id == card.id) {
                let start = &candidate.direction.start;
                if i != j {
                    starts.push(self.start(&self.point.x, card, start, 1.0));
                }
                if !card.absorbed_by.is_empty() {
                    starts.push(self.start(&self.shortened(card, start[0].1), card, start, 1.0));
                }
            }
        }
        let mut best = self.fitted(card, &starts);
        if best.total() > before {
            // Too far away: from a size too small to matter, downhill.
            let small = 0.2 * card.parameters[0].typical[0] / start[0].1.abs();
            best = self.fitted(card, &[self.start(&self.point.x, card, start, small)]);
        }
        let gain = before - best.total();
        Trial { card, point: best, gain }
    }

    /// The numbers `x` with the effect at `shrink` times `sizes`.
    fn start(&self, x: &[f64], card: &Card, sizes: &[(usize, f64)], shrink: f64) -> Vec<f64> {
        let mut x = x.to_vec();
        span(card).for_each(|k| x[k] = 0.0);
        sizes.iter().for_each(|(k, value)| x[*k] = value * shrink);
        x
    }

    /// The effect fitted from that of `starts` that does best after a few steps, in the forms that flights show beside
    /// its size.
    fn fitted(&self, card: &Card, starts: &[Vec<f64>]) -> FitPoint {
        let mut forms: Vec<usize> = card.forms.iter().map(|i| span(card).start + i).collect();
        let mut own: Vec<usize> = span(card).filter(|k| !forms.contains(k)).collect();
        let glance = |x: &Vec<f64>| fit::refit_in(GLANCE, self.problem, self.whitener, self.point, &own, x);
        let first = match starts {
            [only] => only.clone(),
            _ => {
                let all = starts.par_iter().map(glance);
                all.min_by(|a, b| a.total().total_cmp(&b.total())).map_or(self.point.x.clone(), |at| at.x)
            }
        };
        let mut best = fit::refit(self.problem, self.whitener, self.point, &own, &first);
        let least = form_gain(self.point.total() - best.total());
        loop {
            let with = |&k: &usize| {
                let all = [&own[..], &[k]].concat();
                (k, fit::refit(self.problem, self.whitener, self.point, &all, &best.x))
            };
            let tried = forms.par_iter().map(with).min_by(|a, b| a.1.total().total_cmp(&b.1.total()));
            match tried {
                Some((form, point)) if best.total() - point.total() > least => {
                    forms.retain(|k| *k != form);
                    own.push(form);
                    best = point;
                }
                _ => return best,
            }
        }
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
