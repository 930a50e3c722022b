//! Constant errors of the IMU, which every fit allows for, and what they may be instead.

use super::judge::{Judged, judge};
use crate::insight::criteria::material::MATERIAL_BIAS;
use crate::insight::criteria::rival::{ACROSS_SHARE, TIE_DEVIATIONS};
use crate::insight::diagnose::fitting::fit::fit;
use crate::insight::diagnose::fitting::unseen::deviations;
use crate::insight::diagnose::prediction::channels::{PUSH, TURN};
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::selection::Added;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::{self, Card, Quantity, ResidualChannel, Role};

/// Those that matter, judged.
pub fn constant_errors(fitted: &FittedSelection) -> Vec<Judged> {
    let point = &fitted.selection.point;
    let mut out = Vec::new();
    for card in effects::acting(Role::ConstantError) {
        let channel = if card.channels.contains(&ResidualChannel::Turn) { TURN } else { PUSH };
        let size = span(card).map(|k| point.x[k].powi(2)).sum::<f64>().sqrt();
        if !fitted.problem.rows[channel].is_empty() && size > MATERIAL_BIAS.get() * card.parameters[0].typical[0] {
            out.push(judge(fitted, &Added { card, ties: taken_for(fitted, card) }));
        }
    }
    out
}

/// Rivals of a constant error that explain the flights as well in its place: a flight at one throttle does not tell
/// what goes with the throttle from what is always there. A vibration may always be one of them.
fn taken_for(fitted: &FittedSelection, card: &Card) -> Vec<&'static Card> {
    let (problem, point) = (fitted.problem, fitted.point());
    let new = alike(card).filter(|rival| fitted.places(rival).is_empty());
    let as_good = |rival: &&'static Card| {
        let mut x = point.x.clone();
        span(card).for_each(|k| x[k] = problem.model.base[k]);
        let rest = point.free.iter().copied().filter(|k| !span(card).contains(k));
        let other = fit(problem, &fitted.selection.whitener, &x, &rest.chain(span(rival)).collect::<Vec<_>>());
        let worse: Vec<f64> = other.cost.iter().zip(&point.cost).map(|(a, b)| a - b).collect();
        deviations(&worse) < TIE_DEVIATIONS.get()
    };
    let off = [0, 1, 2].map(|i| point.x[span(card).start + i]);
    let shakes = |rival: &&'static Card| shaking(card, off).any(|shakes| shakes.id == rival.id);
    new.filter(|rival| shakes(rival) || as_good(rival)).collect()
}

/// Rivals of a constant error that is `off` on each axis, which go with the throttle: how a vibration does is each
/// vehicle's own, so that an error along the thrust alone may be one.
pub fn shaking(card: &Card, off: [f64; 3]) -> impl Iterator<Item = &'static Card> {
    let [x, y, z] = off;
    let along_thrust = x.hypot(y) < ACROSS_SHARE.get() * z.abs();
    alike(card).filter(move |rival| along_thrust && rival.reads.contains(&Quantity::ThrustCommand))
}

/// Rivals of `card` that change what it changes.
fn alike(card: &Card) -> impl Iterator<Item = &'static Card> {
    card.rivals.iter().filter_map(|id| effects::card(id)).filter(|rival| rival.writes == card.writes)
}
