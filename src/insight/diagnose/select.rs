//! Which effects explain the residuals: rank by score, refit the best and their rivals, keep the best, and again.

use super::candidates::{Candidate, base_numbers, candidates, causes, renewed};
use super::fit::{self, FitPoint};
use super::numbers::span;
use super::problem::{ChannelValues, Problem};
use super::rank::{Reach, rank};
use super::size::is_material;
use super::trial::{GAIN, tied, try_best};
use super::whiten::Whitener;
use crate::insight::estimate::gram::Grams;
use crate::model::effects::{Card, are_rivals};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Most effects that are added.
const MOST: usize = 8;
/// Fall of the whitened squares for which even an effect of no size that matters is added.
const NUISANCE: f64 = 400.0;
/// Rivals compete where the one leaves at most this share of its gain to the other.
const COMPETES: f64 = 0.3;

/// What selection ended with.
pub struct Selection {
    pub point: FitPoint,
    pub whitener: Whitener,
    /// Effects added, in the order of their gain when added, with those that nearly took their place.
    pub added: Vec<Added>,
    /// The fit of the compact model alone, under the same whitening.
    pub base: FitPoint,
    pub reach: Vec<Reach>,
    /// Causes that were not added.
    pub others: Vec<Candidate>,
}

impl Selection {
    /// The same without the effects `ids`, fitted again.
    pub fn without(&self, problem: &Problem, ids: &[&str]) -> Self {
        let gone = |a: &Added| ids.contains(&a.card.id);
        let dropped: Vec<usize> = self.added.iter().filter(|a| gone(a)).flat_map(|a| span(a.card)).collect();
        let mut x = self.point.x.clone();
        dropped.iter().for_each(|&k| x[k] = 0.0);
        let free: Vec<usize> = self.point.free.iter().copied().filter(|k| !dropped.contains(k)).collect();
        Self {
            point: fit::fit(problem, &self.whitener, &x, &free),
            whitener: self.whitener.clone(),
            added: self.added.iter().filter(|a| !gone(a)).cloned().collect(),
            base: self.base.clone(),
            reach: Vec::new(),
            others: Vec::new(),
        }
    }
}

/// An added effect.
#[derive(Clone, Debug)]
pub struct Added {
    pub card: &'static Card,
    pub ties: Vec<&'static Card>,
}

/// Adds effects until none is worth it.
pub fn select(problem: &Problem, watch: &mut dyn FnMut(&str, f64)) -> Selection {
    let free = base_numbers(problem);
    watch("fitting the base", 0.1);
    let plain = problem.residuals(&problem.predict(&problem.model.base));
    let mut whitener = Whitener::plain(&plain, &problem.rows);
    let base_state = problem.predict(&problem.model.base);
    let skewed = super::skew::estimate(problem, &base_state, &plain).is_some_and(|skew| skew.abs() > 5e-5);
    // Clocks that run apart leave nothing that a fit of the base could be about.
    let mut point = if skewed {
        fit::stay(problem, &whitener, &problem.model.base, &free)
    } else {
        fit::fit(problem, &whitener, &problem.model.base, &free)
    };
    let mut added: Vec<Added> = Vec::new();
    let mut reach = Vec::new();
    let mut pending: Vec<(&'static Card, f64)> = Vec::new();
    let mut found: Vec<Candidate> = Vec::new();
    for round in 0..=MOST {
        watch("weighing causes", 0.2 + 0.6 * round as f64 / MOST as f64);
        let held: Vec<&'static Card> = added.iter().map(|a| a.card).collect();
        found = if round == 0 {
            candidates(problem, &whitener, &point, &causes(problem))
        } else {
            renewed(problem, &whitener, &point, &held, &pending, found)
        };
        // Noise is what is left when everything is taken off that any cause could explain.
        for _ in 0..if round == 0 { 2 } else { 1 } {
            whitener = saturated(problem, &whitener, &point, &found);
            point = if skewed && round == 0 {
                fit::stay(problem, &whitener, &point.x, &point.free)
            } else {
                fit::fit(problem, &whitener, &point.x, &point.free)
            };
            found.par_iter_mut().for_each(|c| c.white = whitener.apply(&c.change, &problem.rows));
        }
        let (scored, reached) = rank(problem, &whitener, &point, &found, round == 0);
        if round == 0 {
            reach = reached;
        }
        // What had the same gain for another reason has it still.
        if let Some(last) = added.last_mut() {
            let still = |card: &Card| {
                let gains = scored.iter().filter(|s| found[s.0].card().id == card.id).map(|s| s.1);
                gains.fold(0.0, f64::max)
            };
            last.ties =
                pending.drain(..).filter(|(card, gain)| still(card) < COMPETES * gain).map(|(card, _)| card).collect();
        }
        if round == MOST {
            break;
        }
        let mut trials = try_best(problem, &whitener, &point, &found, &scored);
        // Beside a rival that is already there, it would only take that one's place.
        trials.retain(|t| !(t.bounded(problem) && held.iter().any(|h| are_rivals(h, t.card))));
        let best_of = |material: bool| {
            let fitting = trials.iter().filter(|t| !material || is_material(t.card, &t.point.x));
            fitting.max_by(|a, b| a.merit(problem).total_cmp(&b.merit(problem)))
        };
        let Some(mut best) = best_of(false) else { break };
        // What is too small to matter is kept beside the causes only where it would stand in their way.
        if !is_material(best.card, &best.point.x) && best.gain < NUISANCE {
            match best_of(true) {
                Some(material) if material.gain >= GAIN => best = material,
                _ => break,
            }
        }
        if best.gain < GAIN {
            break;
        }
        let near = trials.iter().filter(|t| t.card.id != best.card.id && tied(best, t));
        pending = near.map(|t| (t.card, t.gain)).collect();
        added.push(Added { card: best.card, ties: Vec::new() });
        point = fit::fit(problem, &whitener, &best.point.x, &best.point.free);
    }
    let base = if added.is_empty() { point.clone() } else { fit::fit(problem, &whitener, &problem.model.base, &free) };
    Selection { point, whitener, added, base, reach, others: found }
}

/// The whitener of what is left when all columns are taken off.
fn saturated(problem: &Problem, whitener: &Whitener, point: &FitPoint, found: &[Candidate]) -> Whitener {
    let residual = whitener.apply(&point.residual, &problem.rows);
    let all: Vec<&ChannelValues> =
        point.white.iter().chain(found.iter().map(|c| &c.white)).chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let Some((beta, _)) = together(&grams) else { return whitener.clone() };
    let mut left = point.residual.clone();
    let raw: Vec<ChannelValues> = point.free.par_iter().map(|&k| problem.slope(&point.state, &point.x, k)).collect();
    for (j, column) in raw.iter().chain(found.iter().map(|c| &c.change)).enumerate() {
        for (left, column) in left.iter_mut().zip(column) {
            left.iter_mut().zip(column).for_each(|(l, x)| *l -= beta[(j, 0)] * x);
        }
    }
    Whitener::of(&left, &problem.rows)
}

/// By how much the whitened squares of `point` would still fall if every number and every cause were fitted, less what that takes of the noise alone.
pub fn left_to_gain(problem: &Problem, whitener: &Whitener, point: &FitPoint, selection: &Selection) -> f64 {
    let own = fit::whitened_slopes(problem, whitener, &point.state, &point.x, &selection.point.free);
    let causes: Vec<ChannelValues> =
        selection.others.par_iter().map(|c| whitener.apply(&c.change, &problem.rows)).collect();
    let residual = whitener.apply(&point.residual, &problem.rows);
    let all: Vec<&ChannelValues> = own.iter().chain(&causes).chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let Some((beta, n)) = together(&grams) else { return 0.0 };
    let along = Grams::pick(&grams.sum, &(0..n).collect::<Vec<_>>(), &[n]);
    ((beta.transpose() * along)[(0, 0)] - n as f64).max(0.0)
}

/// All columns of `grams` but the last, fitted to the last, and how many they are.
fn together(grams: &Grams) -> Option<(DMatrix<f64>, usize)> {
    let n = grams.sum.nrows() - 1;
    let own: Vec<usize> = (0..n).collect();
    let square = Grams::pick(&grams.sum, &own, &own);
    // Columns at several sizes of one effect are nearly the same: a small ridge decides among them.
    let ridge: Vec<f64> = (0..n).map(|i| 1e-4 * square[(i, i)] + 1e-12).collect();
    Some((crate::insight::estimate::inverse::inverse(&square, &ridge)? * Grams::pick(&grams.sum, &own, &[n]), n))
}
