//! What puts a finding in doubt beyond the structure that is left: it does not pay on unseen flight, another one
//! cancels it, or attitude and velocity do not show what a sensor is said to have.

mod cancel;
mod kinematic;

use super::finding::{Finding, Status};
use super::fitted::FittedSelection;
use super::unseen;
use crate::insight::criteria::unseen::PAYS_DEVIATIONS;
use crate::model::effects::{self, Card, Role};

/// Makes findings that are in doubt no more than suspected.
pub fn all(fitted: &FittedSelection, findings: &mut [Finding]) {
    cancelling(fitted, findings);
    unshown(fitted, findings);
    unpaid(fitted, findings);
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
    for [a, b] in cancel::pairs(fitted, &cards.iter().map(|(_, card)| *card).collect::<Vec<_>>()) {
        let (a, b) = (cards[a], cards[b]);
        for ((i, _), (_, other)) in [(a, b), (b, a)] {
            findings[i].suspect(format!("it and {} cancel each other: this flight cannot tell either", other.name));
        }
    }
}

fn unshown(fitted: &FittedSelection, findings: &mut [Finding]) {
    let missing = kinematic::missing(fitted);
    for (i, card) in named(fitted, findings) {
        if missing.iter().any(|other| other.id == card.id) {
            findings[i].suspect("attitude and velocity do not show it in the same size".into());
        }
    }
}

fn unpaid(fitted: &FittedSelection, findings: &mut [Finding]) {
    // Lost commands are counted, not fitted.
    let mut cards = named(fitted, findings);
    cards.retain(|(_, card)| card.role != Role::CommandsLost);
    let places: Vec<Vec<usize>> = cards.iter().map(|(_, card)| fitted.places(card)).collect();
    for ((i, _), deviations) in
        cards.into_iter().zip(unseen::pays(fitted, &unseen::parts(fitted.problem), &places, f64::INFINITY))
    {
        if deviations < PAYS_DEVIATIONS.get() {
            findings[i].suspect("on flight that was not used for fitting it does not pay".into());
        }
    }
}
