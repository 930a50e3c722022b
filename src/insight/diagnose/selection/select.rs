//! Which effects explain the residuals: rank by score, refit the best and their rivals, keep the best, and again.

use super::begin::begin;
use super::candidates::{Candidate, base_numbers, candidates, causes, renewed};
use super::left_over::saturated;
use super::rank::rank;
use super::reach::{Reach, reach};
use super::trial::{Trial, tied, try_best, try_these};
use super::{Added, Selection};
use crate::insight::criteria::consistent::CLOCK_SKEW_SEEN;
use crate::insight::criteria::evident::{LEAST_GAIN, MOST_EFFECTS, MOST_RATE_EFFECTS, NUISANCE_GAIN};
use crate::insight::criteria::rival::RIVAL_KEEPS;
use crate::insight::diagnose::fitting::bend::bend;
use crate::insight::diagnose::fitting::fit::{self, FitPoint};
use crate::insight::diagnose::fitting::size::{is_bounded, is_material};
use crate::insight::diagnose::fitting::told::told;
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::bends;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects::{Card, ResidualChannel, are_rivals};
use rayon::prelude::*;

/// Adds effects until none is worth it.
pub fn select(problem: &Problem, watch: &mut dyn FnMut(&str, f64)) -> Selection {
    watch("fitting the base", 0.1);
    let mut search = Search::new(problem, &base_numbers(problem));
    let free = search.point.free.clone();
    let mut reached: Vec<Reach> = Vec::new();
    let most = MOST_EFFECTS.count();
    for round in 0..=most {
        watch("weighing causes", 0.2 + 0.6 * round as f64 / most as f64);
        search.find(round == 0);
        let ranking = rank(problem, &search.whitener, &search.point, &search.found);
        if round == 0 {
            reached = reach(&ranking, &search.found);
        }
        search.keep_ties(&ranking.order);
        if round == most || !search.add(&ranking.order) {
            if round > 0 {
                Reach::renew(&mut reached, reach(&ranking, &search.found));
            }
            break;
        }
    }
    let Search { whitener, point, added, found, .. } = search;
    let base = if added.is_empty() { point.clone() } else { fit::fit(problem, &whitener, &problem.model.base, &free) };
    Selection { point, whitener, added, base, reach: reached, others: found }
}

/// A selection on its way.
struct Search<'a> {
    problem: &'a Problem,
    /// Whether clocks run apart: that leaves nothing that a fit of the base could be about.
    skewed: bool,
    whitener: Whitener,
    point: FitPoint,
    added: Vec<Added>,
    /// What nearly took the place of the last one added, with its gain.
    pending: Vec<(&'static Card, f64)>,
    found: Vec<Candidate>,
}

impl<'a> Search<'a> {
    /// The base alone, with those of the numbers `free` that the flights tell.
    fn new(problem: &'a Problem, free: &[usize]) -> Self {
        let base = &problem.model.base;
        let state = problem.predict(base);
        let plain = problem.residuals(&state);
        let whitener = Whitener::plain(&plain, &problem.rows);
        let skewed = crate::insight::diagnose::fitting::skew::estimate(problem, &state, &plain)
            .is_some_and(|skew| skew.abs() > CLOCK_SKEW_SEEN.get());
        let point = if skewed {
            fit::stay(problem, &whitener, base, free)
        } else {
            told(problem, &whitener, &begin(problem, &whitener), free)
        };
        Search { problem, skewed, whitener, point, added: Vec::new(), pending: Vec::new(), found: Vec::new() }
    }

    fn held(&self) -> Vec<&'static Card> {
        self.added.iter().map(|a| a.card).collect()
    }

    /// Candidates beside what is held, whitened by what they and the base leave.
    fn find(&mut self, first: bool) {
        let problem = self.problem;
        self.found = if first {
            candidates(problem, &self.whitener, &self.point, &causes(problem))
        } else {
            let found = std::mem::take(&mut self.found);
            renewed(problem, &self.whitener, &self.point, &self.held(), &self.pending, found)
        };
        // Noise is what is left when everything is taken off that any cause could explain.
        for _ in 0..if first { 2 } else { 1 } {
            self.whitener = saturated(problem, &self.whitener, &self.point, &self.found);
            let fit = if self.skewed && first { fit::stay_again } else { fit::again };
            self.point = fit(problem, &self.whitener, &self.point);
            let whitener = &self.whitener;
            self.found.par_iter_mut().for_each(|c| c.white = whitener.apply(&c.change, &problem.rows));
        }
    }

    /// Of what nearly took the place of the last one added, that which loses its gain beside it: what had the same gain
    /// for another reason has it still.
    fn keep_ties(&mut self, order: &[(usize, f64, f64)]) {
        let Some(last) = self.added.last_mut() else { return };
        let still = |card: &Card| {
            let gains = order.iter().filter(|s| self.found[s.0].card().id == card.id).map(|s| s.1);
            gains.fold(0.0, f64::max)
        };
        let ties = self.pending.drain(..).filter(|(card, gain)| still(card) < RIVAL_KEEPS.get() * gain);
        last.ties = ties.map(|(card, _)| card).collect();
    }

    /// Adds the best of the first of the ranking, if it is worth it.
    fn add(&mut self, order: &[(usize, f64, f64)]) -> bool {
        let problem = self.problem;
        let of_rates = |card: &Card| card.channels.iter().all(|c| *c == ResidualChannel::Rate);
        let full = self.added.iter().filter(|a| of_rates(a.card)).count() >= MOST_RATE_EFFECTS.count();
        let open = |s: &&(usize, f64, f64)| !(full && of_rates(self.found[s.0].card()));
        let order: Vec<_> = order.iter().filter(open).copied().collect();
        let mut trials = try_best(problem, &self.whitener, &self.point, &self.found, &order);
        trials.retain(|t| !t.contradicted(problem, &self.whitener, &self.point));
        // Beside a rival that is already there, it would only take that one's place.
        let held = self.held();
        trials.retain(|t| !(t.bounded(problem) && held.iter().any(|h| are_rivals(h, t.card))));
        let Some(best) = best(problem, &trials) else { return false };
        if bends::thrusts(best.card) {
            // How thrust goes with throttle and voltage is the vehicle's own.
            let bent = bend(problem, &self.whitener, self.point.clone(), &[best.card]);
            if bent.free.len() > self.point.free.len() {
                self.point = bent;
                return true;
            }
        }
        let near = trials.iter().filter(|t| t.card.id != best.card.id && tied(best, t));
        self.pending = near.map(|t| (t.card, t.gain)).collect();
        self.added.push(Added { card: best.card, ties: Vec::new() });
        let point = fit::fit(problem, &self.whitener, &best.point.x, &best.point.free);
        let point = self.without_displaced(point, best.card);
        let bent = bend(problem, &self.whitener, point.clone(), &self.held());
        self.point = self.with_yaw_apart(&point, best.card, bent.total()).unwrap_or(bent);
        true
    }

    /// Without what ends at a bound beside a rival, now that `new` is there: the rival has taken its place, and it
    /// would only take the certainty from the others. It is a candidate again.
    fn without_displaced(&mut self, point: FitPoint, new: &Card) -> FitPoint {
        let held = self.held();
        let displaced = |card: &Card| {
            card.id != new.id && held.iter().any(|h| are_rivals(card, h)) && is_bounded(self.problem, card, &point.x)
        };
        let gone: Vec<&'static Card> = held.iter().copied().filter(|card| displaced(card)).collect();
        if gone.is_empty() {
            return point;
        }
        self.added.retain(|a| !gone.iter().any(|card| card.id == a.card.id));
        let numbers: Vec<usize> = gone.iter().flat_map(|card| span(card)).collect();
        let point = fit::fit_without(self.problem, &self.whitener, &point, &numbers);
        self.found.extend(candidates(self.problem, &self.whitener, &point, &gone));
        point
    }

    /// Yaw's own share beside the effect `of` all axes, where that explains more than bending the response of `point`
    /// does: a bend takes up most of what would name it.
    fn with_yaw_apart(&mut self, point: &FitPoint, of: &Card, bent: f64) -> Option<FitPoint> {
        let mut order: Vec<usize> = (0..self.found.len()).collect();
        order.retain(|&j| self.found[j].card().apart_from.contains(&of.id));
        order.dedup_by_key(|j| self.found[*j].card().id);
        let trials = try_these(self.problem, &self.whitener, point, &self.found, &order);
        let best = trials.into_iter().min_by(|a, b| a.point.total().total_cmp(&b.point.total()))?;
        let pays = best.point.total() < bent - LEAST_GAIN.get() && is_material(best.card, &best.point.x);
        (pays && !best.bounded(self.problem)).then(|| {
            // Before the last, whose ties are still to be found.
            let last = self.added.len().saturating_sub(1);
            self.added.insert(last, Added { card: best.card, ties: Vec::new() });
            self.pending.retain(|(card, _)| card.id != best.card.id);
            fit::fit(self.problem, &self.whitener, &best.point.x, &best.point.free)
        })
    }
}

/// The best of the trials, if it is worth adding.
fn best<'a>(problem: &Problem, trials: &'a [Trial]) -> Option<&'a Trial> {
    let best_of = |material: bool| {
        let fitting = trials.iter().filter(|t| !material || is_material(t.card, &t.point.x));
        fitting.max_by(|a, b| a.merit(problem).total_cmp(&b.merit(problem)))
    };
    let best = best_of(false)?;
    // What is too small to matter is kept beside the causes only where it would stand in their way.
    let counts = is_material(best.card, &best.point.x) || best.gain >= NUISANCE_GAIN.get();
    if counts { Some(best) } else { best_of(true) }.filter(|best| best.gain >= LEAST_GAIN.get())
}
