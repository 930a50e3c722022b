//! What every vehicle has comes before what a recorder seldom has. Clocks that run apart shift the rates more and more,
//! and so do a delay and a response that slows with the voltage together. A gyro that is stamped late is a delay of the
//! rates to the commands, and only attitude and velocity tell: not where the velocity comes late itself.

use super::{Added, Selection};
use crate::base::stats::mean;
use crate::insight::criteria::evident::LEAST_GAIN;
use crate::insight::criteria::rival::{SLOWED_MOST_S, TIE_DEVIATIONS};
use crate::insight::diagnose::fitting::bend::bend;
use crate::insight::diagnose::fitting::fit::{self, FitPoint};
use crate::insight::diagnose::fitting::unseen::deviations;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects::{self, Card, Role};

/// Puts the effects that together look like a seldom one in its place, unless they do worse.
pub fn first(problem: &Problem, selection: &mut Selection) {
    let late = selection.added.iter().any(|a| a.card.role == Role::VelocityLag);
    let seldom = |card: &&Card| !card.together.is_empty() && (late || card.role != Role::GyroLate);
    for card in effects::cards().filter(seldom) {
        if let Some(at) = selection.added.iter().position(|a| a.card.id == card.id) {
            instead(problem, selection, at);
        }
    }
}

/// The same of the effect that was added as number `at`.
fn instead(problem: &Problem, selection: &mut Selection, at: usize) {
    let seldom = selection.added[at].card;
    let mut x = selection.point.x.clone();
    let size = x[span(seldom).start];
    // By how much the rates are shifted on average, and at most.
    let [shift, most] = match seldom.role {
        Role::ClockFast => [1.0, 2.0].map(|times| times * size * middle(problem)),
        _ => [size; 2],
    };
    if most.abs() > SLOWED_MOST_S.get() {
        return;
    }
    let held = |card: &Card| selection.added.iter().any(|a| a.card.id == card.id);
    let together: Vec<&'static Card> = seldom.together.iter().filter_map(|id| effects::card(id)).collect();
    span(seldom).for_each(|k| x[k] = 0.0);
    for card in &together {
        let (p, k) = (&card.parameters[0], span(card).start);
        let number = &problem.model.numbers[k];
        if p.unit == "s" {
            x[k] += shift;
        } else if !held(card) {
            x[k] = p.typical[0];
        }
        x[k] = x[k].clamp(number.low, number.high);
    }
    let new: Vec<&'static Card> = together.into_iter().filter(|card| !held(card)).collect();
    let mut free = selection.point.free.clone();
    free.retain(|k| !span(seldom).contains(k));
    free.extend(new.iter().flat_map(|card| span(card)));
    let mut added = selection.added.clone();
    added.splice(at..=at, new.iter().map(|card| Added { card, ties: Vec::new() }));
    let cards: Vec<&'static Card> = added.iter().map(|a| a.card).collect();
    let whitener = &selection.whitener;
    let point = bend(problem, whitener, fit::fit(problem, whitener, &x, &free), &cards);
    if !worse(&point, &selection.point) {
        (selection.added, selection.point) = (added, point);
    }
}

/// The middle of the flights, on their clocks, s.
fn middle(problem: &Problem) -> f64 {
    let one = |time: &Vec<f64>| Some(0.5 * (time.first()? + time.last()?));
    mean(&problem.records.iter().filter_map(|r| one(&r.time)).collect::<Vec<_>>())
}

/// Whether stretches of time tell that `point` explains less than `than`.
fn worse(point: &FitPoint, than: &FitPoint) -> bool {
    let differences: Vec<f64> = point.cost.iter().zip(&than.cost).map(|(a, b)| a - b).collect();
    point.total() - than.total() > LEAST_GAIN.get() && deviations(&differences) > TIE_DEVIATIONS.get()
}
