//! Effects tried beside what stands: fitted with the base, each from all sizes that could be it.

use super::candidates::{Candidate, Direction};
use super::fit::{self, FitPoint};
use super::judge::is_bounded;
use super::model::{TAU, span};
use super::problem::Problem;
use super::select::{EVIDENCE, GAIN};
use super::whiten::Whitener;
use crate::model::effects::Card;
use rayon::prelude::*;

/// Candidates refitted in a round, besides the rivals of the first.
const SHORT_LIST: usize = 6;
/// Fall of the whitened squares for which even a few stretches are enough to be looked at.
const RARE: f64 = 100.0;
/// Rivals that come so near the best by standard deviations of their difference are a tie.
const TIE: f64 = 2.5;

/// An effect that was tried beside what stands.
pub struct Trial {
    pub card: &'static Card,
    pub point: FitPoint,
    /// Fall of the whitened squares.
    pub gain: f64,
}

impl Trial {
    /// Gain; half of it where a number ends at the bound of its range, for then the effect stands in for something else.
    pub fn merit(&self, problem: &Problem) -> f64 {
        if self.bounded(problem) { 0.5 * self.gain } else { self.gain }
    }

    pub fn bounded(&self, problem: &Problem) -> bool {
        is_bounded(problem, self.card, &self.point.x)
    }
}

/// Whether two causes are known to look alike.
pub fn rivals(a: &Card, b: &Card) -> bool {
    a.rivals.contains(&b.id) || b.rivals.contains(&a.id)
}

/// Whether a trial comes so near the best that their stretches of time do not decide.
pub fn tied(best: &Trial, other: &Trial) -> bool {
    let differences: Vec<f64> = other.point.cost.iter().zip(&best.point.cost).map(|(a, b)| a - b).collect();
    let sum: f64 = differences.iter().sum();
    let spread = differences.iter().map(|d| d * d).sum::<f64>().sqrt();
    other.gain > GAIN && sum < TIE * spread
}

/// The time constants that a delay is mistaken for.
fn delayed(card: &Card) -> std::ops::Range<usize> {
    match card.id {
        "rate_delay" | "stream_offset" => TAU.start..TAU.start + 3,
        "yaw_delay" => TAU.start + 2..TAU.start + 3,
        "thrust_delay" => TAU.start + 3..TAU.end,
        _ => 0..0,
    }
}

/// Refits the first of the ranking, and the rivals of the very first.
pub fn try_best(
    problem: &Problem,
    whitener: &Whitener,
    point: &FitPoint,
    found: &[Candidate],
    order: &[(usize, f64, f64)],
) -> Vec<Trial> {
    let mut chosen: Vec<usize> = Vec::new();
    for &(j, gain, evidence) in order {
        let card = found[j].card();
        let known = chosen.iter().any(|&i| found[i].card().id == card.id);
        let leader = chosen.first().map(|&i| found[i].card());
        let rival = leader.is_some_and(|l| rivals(l, card));
        if !known
            && gain > 0.5 * GAIN
            && (evidence > 0.5 * EVIDENCE || gain > RARE)
            && (chosen.len() < SHORT_LIST || rival)
        {
            chosen.push(j);
        }
    }
    let before = point.total();
    let from = |x: &[f64], card: &'static Card, start: &[(usize, f64)], shrink: f64| {
        let own: Vec<usize> = span(card).collect();
        let mut x = x.to_vec();
        own.iter().for_each(|&k| x[k] = 0.0);
        start.iter().for_each(|(k, value)| x[*k] = value * shrink);
        fit::refit(problem, whitener, point, &own, &x)
    };
    let refitted = |card, start: &[(usize, f64)], shrink| from(&point.x, card, start, shrink);
    // A lag that was fitted without its delay is too long by about that.
    let shortened = |card: &Card, delay: f64| {
        let mut x = point.x.clone();
        delayed(card).for_each(|k| x[k] = (x[k] - delay).max(0.3 * x[k]).max(problem.model.numbers[k].low));
        x
    };
    let one = |&j: &usize| {
        let Direction { card, start } = &found[j].direction;
        let mut best = refitted(card, start, 1.0);
        if best.total() > before {
            // Too far away: from a size too small to matter, downhill.
            best = refitted(card, start, 0.2 * card.parameters[0].typical[0] / start[0].1.abs());
        }
        if card.parameters[0].unit == "s" {
            // Late signals fit at more than one delay.
            let others = found.iter().enumerate().filter(|(i, c)| *i != j && c.card().id == card.id);
            let others = others.map(|(_, other)| refitted(card, &other.direction.start, 1.0));
            let beside =
                found.iter().map(|c| &c.direction).filter(|d| d.card.id == card.id && !delayed(card).is_empty());
            let beside = beside.map(|d| from(&shortened(card, d.start[0].1), card, &d.start, 1.0));
            for another in others.chain(beside) {
                if another.total() < best.total() {
                    best = another;
                }
            }
        }
        let gain = before - best.total();
        Trial { card, point: best, gain }
    };
    chosen.par_iter().map(one).collect()
}
