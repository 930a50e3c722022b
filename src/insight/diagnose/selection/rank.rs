//! Directions in the order of what they would explain, and what a log could show at all.

use super::candidates::Candidate;
use crate::insight::criteria::flown::ABSORBED_SHARE;
use crate::insight::diagnose::fitting::fit::FitPoint;
use crate::insight::diagnose::fitting::score::score;
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::insight::estimate::gram::Grams;
use crate::model::effects::Card;
use rayon::prelude::*;

/// What a log could show of an effect, before any residual is looked at.
#[derive(Clone, Debug)]
pub struct Reach {
    pub card: &'static Card,
    /// Information on the main parameter that the base leaves, and the share of all that it is.
    pub information: f64,
    pub kept: f64,
    /// The rival most like it, and how much (correlation of what is left).
    pub nearest: Option<(&'static str, f64)>,
}

/// Directions by the expected fall of the whitened squares, the best first; and what the log could show of each effect.
pub fn rank(
    problem: &Problem,
    whitener: &Whitener,
    point: &FitPoint,
    found: &[Candidate],
    reach_too: bool,
) -> (Vec<(usize, f64, f64)>, Vec<Reach>) {
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
    let mut reach: Vec<Reach> = Vec::new();
    if !reach_too {
        return (order, reach);
    }
    for (j, s) in scores.iter().enumerate() {
        let (Some(s), card) = (s, found[j].card()) else { continue };
        if reach.iter().any(|r| r.card.id == card.id) {
            continue;
        }
        let size = found[j].direction.start[0].1;
        let (information, kept) = (s.information[0] / (size * size), s.information[0] / s.raw[0].max(1e-300));
        let near = |i: usize| {
            // Information on the first that the second leaves, as a share.
            let alone = s.information[0];
            let other = score(&grams, &[&rest[..], &[n + i]].concat(), &[n + j], all.len() - 1, &prior)?;
            Some((found[i].card().id, (1.0 - other.information[0] / alone).clamp(0.0, 1.0).sqrt()))
        };
        let rivals = (0..found.len()).filter(|&i| card.rivals.contains(&found[i].card().id));
        let nearest = rivals.filter_map(near).max_by(|a, b| a.1.total_cmp(&b.1));
        reach.push(Reach { card, information, kept, nearest });
    }
    (order, reach)
}
