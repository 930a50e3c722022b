//! What puts a finding in doubt beyond the structure that is left: it does not pay on unseen flight, another one
//! cancels it, attitude and velocity do not show what a sensor is said to have, thrust does not show a clock, moments
//! of the air may be it, or its size is negative, as something else makes it.

mod alone;
mod cancel;
mod clock;
mod kinematic;
mod moments;

use super::finding::{Finding, Status};
use super::{late_gyro, pays};
use crate::insight::criteria::unseen::{PAYS_DEVIATIONS, SAME_SKEW_SHARE};
use crate::insight::diagnose::fitting::skew;
use crate::insight::diagnose::fitting::unseen;
use crate::insight::diagnose::prediction::channels::TURN;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::{self, Card, Role, are_rivals};

/// Makes findings that are in doubt no more than suspected.
pub fn all(fitted: &FittedSelection, findings: &mut [Finding]) {
    cancelling(fitted, findings);
    unshown(fitted, findings);
    unpaid(fitted, findings);
    untimed(fitted, findings);
    held(fitted, findings);
    negative(findings);
    late_gyro::may_be(fitted.problem.moved(), findings);
}

/// Where something else makes a size negative more often than the effect does.
fn negative(findings: &mut [Finding]) {
    let is_negative = |f: &Finding| f.parameters.values().any(|v| v.value < 0.0);
    for finding in findings.iter_mut().filter(|f| f.status != Status::Suspected && is_negative(f)) {
        if let Some(card) = effects::card(finding.effect).filter(|card| !card.negative.is_empty()) {
            finding.suspect(card.negative.into());
        }
    }
}

fn untimed(fitted: &FittedSelection, findings: &mut [Finding]) {
    for (i, card) in named(fitted, findings) {
        if card.role == Role::ClockFast && clock::is_unshown(fitted, card) {
            findings[i].suspect("thrust does not show it: the rates' response may slow instead".into());
        }
    }
}

fn held(fitted: &FittedSelection, findings: &mut [Finding]) {
    let Some(beside) = moments::beside(fitted) else { return };
    for (i, card) in named(fitted, findings) {
        if beside.share(card).is_some_and(moments::may_be) {
            findings[i].suspect(
                "much of it goes with the velocity: a rate loop that gives way to the air's moments does so".into(),
            );
        }
    }
}

/// The cards of findings that are named and fitted, with their places among the findings.
fn named(fitted: &FittedSelection, findings: &[Finding]) -> Vec<(usize, &'static Card)> {
    let known = |(i, f): (usize, &Finding)| Some((i, effects::card(f.effect)?));
    let fitted = |card: &Card| !fitted.places(card).is_empty();
    let sure = findings.iter().enumerate().filter(|(_, f)| f.status != Status::Suspected);
    sure.filter_map(known).filter(|(_, card)| fitted(card)).collect()
}

fn cancelling(fitted: &FittedSelection, findings: &mut [Finding]) {
    let cards = named(fitted, findings);
    let overlap = cancel::overlap(fitted, &cards.iter().map(|(_, card)| *card).collect::<Vec<_>>());
    // Of rivals that write the same and point the same way, one has the name: the form of the cause lies between.
    for [larger, smaller] in overlap.alike().map(|pair| pair.map(|i| cards[i])) {
        if are_rivals(larger.1, smaller.1) && larger.1.writes == smaller.1.writes {
            findings[smaller.0].suspect(format!("it is much like {}: they may be one cause", larger.1.name));
            findings[larger.0].or(smaller.1.id);
        }
    }
    for [a, b] in overlap.cancelling() {
        let (a, b) = (cards[a], cards[b]);
        for ((i, _), (_, other)) in [(a, b), (b, a)] {
            findings[i].suspect(format!("it and {} cancel each other: this flight cannot tell either", other.name));
        }
    }
    for (i, card) in cards {
        if cancel::is_undone(fitted, card) {
            findings[i]
                .suspect("it only undoes a move of the vehicle's own numbers: this flight cannot tell it".into());
        }
    }
}

fn unshown(fitted: &FittedSelection, findings: &mut [Finding]) {
    let missing = kinematic::missing(fitted);
    let no_attitude = fitted.problem.rows[TURN].is_empty();
    for (i, card) in named(fitted, findings) {
        if no_attitude && card.role == Role::GyroLate {
            findings[i].suspect("no attitude in the logs shows it: late commands look the same".into());
        }
        if missing.iter().any(|other| other.id == card.id) {
            findings[i].suspect("attitude and velocity do not show it in the same size".into());
        }
    }
}

fn unpaid(fitted: &FittedSelection, findings: &mut [Finding]) {
    // Lost commands are counted, not fitted; clocks that run apart are followed from one stretch of time to the next,
    // for no step of a linear fit reaches them.
    let mut cards = named(fitted, findings);
    cards.retain(|(_, card)| card.role != Role::CommandsLost && !followed(fitted, card));
    let all = |f: &Finding| f.cards().flat_map(|(card, _)| fitted.places(card)).collect();
    let places: Vec<Vec<usize>> = cards.iter().map(|(i, _)| all(&findings[*i])).collect();
    for ((i, _), paid) in cards.into_iter().zip(pays::pays(fitted, &unseen::even_parts(fitted.problem), &places)) {
        if paid.surely() < PAYS_DEVIATIONS.get() {
            findings[i].suspect("on flight that was not used for fitting it does not pay".into());
        }
    }
}

/// Whether `card` is a skew of the clocks that shifts the rates from one stretch of time to the next by itself.
fn followed(fitted: &FittedSelection, card: &Card) -> bool {
    let problem = fitted.problem;
    let seen = || {
        let state = problem.predict(&problem.model.base);
        skew::estimate(problem, &state, &problem.residuals(&state))
    };
    let size = fitted.point().x[span(card).start];
    card.role == Role::ClockFast && seen().is_some_and(|seen| (seen / size - 1.0).abs() < SAME_SKEW_SHARE.get())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::insight::diagnose::judgement::finding::Value;

    #[test]
    fn what_makes_a_negative_size_without_the_effect_leaves_it_suspected() {
        let status = |card: &'static Card, value: f64| {
            let value = Value { value, low: value - 4e-4, high: value + 4e-4, unit: "s".into() };
            let mut findings =
                [Finding { parameters: [(card.parameters[0].name.into(), value)].into(), ..Finding::of(card) }];
            negative(&mut findings);
            findings[0].status
        };
        let (doubted, others): (Vec<_>, Vec<_>) = effects::cards().partition(|card| !card.negative.is_empty());
        assert_eq!(doubted.len(), 2);
        assert!(effects::acting(Role::GyroLate).all(|card| !card.negative.is_empty()));
        for card in doubted {
            assert_eq!([status(card, -9e-4), status(card, 9e-4)], [Status::Suspected, Status::Named]);
        }
        assert!(others.into_iter().all(|card| status(card, -9e-4) == Status::Named));
    }
}
