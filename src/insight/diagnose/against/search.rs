//! Which differences explain what two sets of flights do not show alike: rank by score, fit the best, judge it beside
//! those that stand, keep it where all of them then hold, and again. What does not hold is no part of later fits: it
//! would only take the certainty from what does.

use super::change::Change;
use super::columns::{Tested, tests};
use super::judge;
use super::part;
use super::suspect::{FoundDifference, Suspect};
use crate::insight::criteria::changed::{CHANGED_EVIDENCE, MOST_CHANGES, MOST_TRIED, PLAIN_SHARE};
use crate::insight::criteria::evident::{BOUNDED_MERIT, GAIN_WORTH_A_FIT, LEAST_GAIN, SHORT_LIST};
use crate::insight::criteria::rival::{RIVAL_KEEPS, TIE_DEVIATIONS};
use crate::insight::diagnose::fitting::fit::{self, FitPoint};
use crate::insight::diagnose::judgement::finding::Status;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::candidates::{Candidate, candidates, own_differences};
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::{Card, are_rivals};
use rayon::prelude::*;

/// A suspect that was tried.
struct Tried {
    suspect: usize,
    point: FitPoint,
    /// Fall of the whitened squares by the difference, beside the same cause in both sets.
    gain: f64,
}

/// A search for differences.
pub struct DifferenceSearch<'a> {
    problem: &'a Problem,
    suspects: &'a [Suspect],
    /// What both sets have in common, and the differences that hold.
    pub selection: Selection,
    pub found: Vec<FoundDifference>,
    /// Numbers where the base vehicle's own effects differ between the sets, which no difference is told from yet.
    apart: Vec<f64>,
    /// What was fitted and did not hold, beside those that did.
    pub rejected: Vec<Change>,
    /// What was tested last.
    pub tested: Vec<Tested>,
    /// What nearly took the place of the last one found, with its gain.
    pending: Vec<(usize, f64)>,
    candidates: Vec<Candidate>,
}

impl<'a> DifferenceSearch<'a> {
    /// From `selection`, which both sets have in common.
    pub fn new(problem: &'a Problem, suspects: &'a [Suspect], mut selection: Selection) -> Self {
        let Selection { point, whitener, .. } = &mut selection;
        let apart = point.x.clone();
        let own: Vec<usize> = own_differences(problem).collect();
        *point = if own.is_empty() {
            fit::again(problem, whitener, point)
        } else {
            fit::fit_without(problem, whitener, point, &own)
        };
        let cards: Vec<&'static Card> = suspects.iter().filter_map(|s| s.card).collect();
        let held = |card: &Card| span(card).any(|k| point.free.contains(&k));
        let cards: Vec<_> = cards.into_iter().filter(|card| !held(card)).collect();
        let candidates = candidates(problem, whitener, point, &cards);
        let (found, rejected, tested, pending) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { problem, suspects, selection, found, apart, rejected, tested, pending, candidates }
    }

    /// Adds differences until none is worth it.
    pub fn run(mut self) -> Self {
        let ended = |search: &Self| search.found.len() >= MOST_CHANGES.count();
        for round in 0..=MOST_TRIED.count() {
            let Selection { point, whitener, .. } = &self.selection;
            let mut order = tests(self.problem, whitener, point, self.suspects, &self.candidates);
            order.sort_by(|a, b| b.score.gain.total_cmp(&a.score.gain));
            self.keep_ties(&order);
            let ends = round == MOST_TRIED.count() || ended(&self) || !self.add(&order);
            self.tested = order;
            if ends {
                break;
            }
        }
        self
    }

    /// Of what nearly took the place of the last one found, that which loses its gain beside it.
    fn keep_ties(&mut self, order: &[Tested]) {
        let Some(last) = self.found.last_mut() else { return };
        let still =
            |suspect: usize| order.iter().filter(|t| t.suspect == suspect).map(|t| t.score.gain).fold(0.0, f64::max);
        let ties = self.pending.drain(..).filter(|(suspect, gain)| still(*suspect) < RIVAL_KEEPS.get() * gain);
        last.ties.extend(ties.map(|(suspect, _)| suspect));
    }

    /// Tries the best that was not tried yet. No more is worth it where there is none.
    fn add(&mut self, order: &[Tested]) -> bool {
        let chosen = self.chosen(order);
        let mut tried: Vec<Tried> = chosen.par_iter().filter_map(|&suspect| self.best(suspect, order)).collect();
        let merit = |t: &Tried| t.gain * if self.bounded(t) { BOUNDED_MERIT.get() } else { 1.0 };
        tried.sort_by(|a, b| merit(b).total_cmp(&merit(a)));
        let worth = |t: &&Tried| merit(t) >= LEAST_GAIN.get() + self.suspects[t.suspect].own.len() as f64;
        let Some(first) = tried.first().filter(worth) else { return false };
        // Of those that do nearly as well the plainest is the answer, of a size that is usual.
        let nearly = |t: &&Tried| tied(first, t) && merit(t) > PLAIN_SHARE.get() * merit(first);
        let plainness = |t: &&Tried| (self.suspects[t.suspect].plainness(), self.is_unusual(t));
        let best = std::iter::once(first).chain(tried.iter().filter(nearly)).min_by_key(plainness).unwrap_or(first);
        let part = part::only(self.problem, &self.selection, self.suspects, &self.suspects[best.suspect], &best.point);
        let best = part.and_then(|part| tried.iter().find(|t| t.suspect == part)).unwrap_or(best);
        let near = tried.iter().filter(|t| t.suspect != best.suspect && tied(best, t));
        let pending = near.map(|t| (t.suspect, t.gain)).collect();
        let (suspect, x, free) = (best.suspect, best.point.x.clone(), best.point.free.clone());
        self.hold(suspect, fit::fit(self.problem, &self.selection.whitener, &x, &free), pending);
        true
    }

    /// Keeps the difference of a suspect, fitted at `point`, where it and all that were found before hold there.
    fn hold(&mut self, suspect: usize, point: FitPoint, pending: Vec<(usize, f64)>) {
        let before = std::mem::replace(&mut self.selection.point, point);
        self.found.push(FoundDifference { suspect, ties: Vec::new() });
        let fitted = FittedSelection::new(self.problem, &self.selection);
        let mut judged = judge::all(&fitted, self.suspects, &self.found);
        if judged.iter().all(|change| change.status != Status::Suspected) {
            self.pending = pending;
            return;
        }
        self.selection.point = before;
        self.found.pop();
        self.rejected.extend(judged.pop());
    }

    /// Suspects that are worth a fit, the best first, and the rivals of the very first.
    fn chosen(&self, order: &[Tested]) -> Vec<usize> {
        let mut chosen: Vec<usize> = Vec::new();
        let rejected = |suspect: usize| self.rejected.iter().any(|change| change.cause == self.suspects[suspect].id);
        let worth = |t: &&Tested| t.score.gain > GAIN_WORTH_A_FIT.get() && t.score.evidence > CHANGED_EVIDENCE.get();
        for tested in order.iter().filter(worth).filter(|t| !rejected(t.suspect)) {
            let card = |suspect: usize| self.suspects[suspect].card;
            let leader = chosen.first().and_then(|&first| card(first));
            let rival = leader.zip(card(tested.suspect)).is_some_and(|(a, b)| are_rivals(a, b));
            if !chosen.contains(&tested.suspect) && (chosen.len() < SHORT_LIST.count() || rival) {
                chosen.push(tested.suspect);
            }
        }
        chosen
    }

    /// A suspect, fitted from the directions that the score thinks most of.
    fn best(&self, suspect: usize, order: &[Tested]) -> Option<Tried> {
        let of = order.iter().filter(|t| t.suspect == suspect);
        // Late signals fit at more than one delay.
        let starts = match self.suspects[suspect].card {
            Some(card) if card.parameters[0].unit == "s" => 4,
            _ => 1,
        };
        let expected = of.take(starts).map(|tested| self.start(&self.suspects[suspect], tested));
        let tried = expected.chain(self.in_one_set(suspect)).map(|x| self.fitted(suspect, &x));
        tried.max_by(|a, b| a.gain.total_cmp(&b.gain))
    }

    /// Where the fit of an effect that both sets have begins as well: in one of them alone, or apart as selection had
    /// it. From both alike a step may not reach that, of a delay.
    fn in_one_set(&self, suspect: usize) -> Vec<Vec<f64>> {
        let (suspect, x) = (&self.suspects[suspect], &self.selection.point.x);
        let contrast = self.problem.contrast.as_ref().filter(|_| suspect.card.is_some());
        let differs = |k: usize| contrast?.of(k).filter(|d| suspect.own.contains(d) && x[k] != 0.0);
        let pairs: Vec<(usize, usize)> = suspect.common().filter_map(|k| Some((k, differs(k)?))).collect();
        let begun = |value: &dyn Fn(usize, usize) -> (f64, f64)| {
            let mut x = x.clone();
            pairs.iter().for_each(|&(k, d)| (x[k], x[d]) = value(k, d));
            x
        };
        if pairs.is_empty() {
            Vec::new()
        } else if pairs.iter().any(|(_, d)| self.apart[*d] != 0.0) {
            vec![begun(&|k, d| (self.apart[k], self.apart[d]))]
        } else {
            vec![begun(&|k, _| (0.0, x[k])), begun(&|k, _| (x[k], -x[k]))]
        }
    }

    /// A suspect fitted from `start`, and what its difference gains.
    fn fitted(&self, place: usize, start: &[f64]) -> Tried {
        let problem = self.problem;
        let Selection { point, whitener, .. } = &self.selection;
        let suspect = &self.suspects[place];
        let unknown = |k: &usize| !point.free.contains(k);
        let common: Vec<usize> = suspect.common().filter(unknown).collect();
        let own: Vec<usize> = common.iter().chain(&suspect.own).copied().collect();
        let with = fit::refit(problem, whitener, point, &own, start);
        let alike = if common.is_empty() {
            point.total()
        } else {
            let mut x = with.x.clone();
            for k in suspect.numbers.clone() {
                let difference = problem.contrast.as_ref().and_then(|c| c.of(k));
                let Some(d) = difference.filter(|d| suspect.own.contains(d)) else { continue };
                x[k] += 0.5 * std::mem::take(&mut x[d]);
                x[k] = x[k].clamp(problem.model.numbers[k].low, problem.model.numbers[k].high);
            }
            fit::refit(problem, whitener, point, &common, &x).total().min(point.total())
        };
        Tried { suspect: place, gain: alike - with.total(), point: with }
    }

    /// Where the fit of a suspect begins: an effect of later flights, or of the earlier ones.
    fn start(&self, suspect: &Suspect, tested: &Tested) -> Vec<f64> {
        let mut x = self.selection.point.x.clone();
        let Some(direction) = &tested.direction else { return x };
        let size = tested.expected.abs().clamp(0.2, 3.0);
        for (k, start) in &direction.start {
            let difference = self.problem.contrast.as_ref().and_then(|c| c.of(*k));
            let number = &self.problem.model.numbers[*k];
            match difference.filter(|d| suspect.own.contains(d)) {
                Some(d) if suspect.is_absorbed() => x[d] = start * size * tested.expected.signum(),
                Some(d) if tested.expected > 0.0 => x[d] = (start * size).clamp(number.low, number.high),
                Some(d) => {
                    x[*k] = (start * size).clamp(number.low, number.high);
                    x[d] = -x[*k];
                }
                None => x[*k] = *start,
            }
        }
        x
    }

    fn bounded(&self, tried: &Tried) -> bool {
        self.suspects[tried.suspect].is_bounded(self.problem, &tried.point.x)
    }

    /// Whether an effect is larger than a racing quadrotor has it, in either set.
    fn is_unusual(&self, tried: &Tried) -> bool {
        self.suspects[tried.suspect].in_a_set(self.problem, &tried.point.x, |card, x| {
            card.sizes().any(|(i, p)| x[span(card).start + i].abs() > p.typical[1])
        })
    }
}

/// Whether stretches of time do not decide between the best and another.
fn tied(best: &Tried, other: &Tried) -> bool {
    let differences: Vec<f64> = other.point.cost.iter().zip(&best.point.cost).map(|(a, b)| a - b).collect();
    let sum: f64 = differences.iter().sum();
    let spread = differences.iter().map(|d| d * d).sum::<f64>().sqrt();
    other.gain > LEAST_GAIN.get() && sum < TIE_DEVIATIONS.get() * spread
}
