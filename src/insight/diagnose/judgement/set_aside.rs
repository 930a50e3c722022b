//! Effects that the flight does not show by themselves, set aside where another is sure without them: several that
//! stand in for one another leave no certainty to any.

use super::finding::{Finding, Status};
use super::judge::judge;
use super::replication::{Replicated, stretches};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::diagnose::selection::{Added, Selection};
use crate::model::effects::{Card, Role};

/// The selection without its weak effects, where that makes an effect sure that many stretches of flight agree on; and
/// what was set aside, suspected.
pub fn set_aside(problem: &Problem, selection: Selection) -> (Selection, Vec<Finding>) {
    let fitted = FittedSelection::new(problem, &selection);
    let counted = |a: &&Added| a.card.role != Role::CommandsLost;
    let shown: Vec<(&Added, Replicated)> =
        selection.added.iter().filter(counted).map(|a| (a, stretches(&fitted, a.card))).collect();
    let unsure: Vec<&'static Card> =
        shown.iter().filter(|(_, r)| r.agreed() && !r.evident()).map(|(a, _)| a.card).collect();
    let beside =
        |card: &Card| unsure.iter().any(|u| u.id != card.id && u.channels.iter().any(|c| card.channels.contains(c)));
    let weak: Vec<&Added> = shown.iter().filter(|(a, r)| r.weak() && beside(a.card)).map(|(a, _)| *a).collect();
    let stay = |card: &&Card| weak.iter().all(|a| a.card.id != card.id);
    if weak.is_empty() || !unsure.iter().any(&stay) {
        return (selection, Vec::new());
    }
    let without = selection.but(problem, &weak.iter().map(|a| a.card.id).collect::<Vec<_>>());
    let refitted = FittedSelection::new(problem, &without);
    if !unsure.iter().filter(|card| stay(card)).any(|card| stretches(&refitted, card).evident()) {
        return (selection, Vec::new());
    }
    let suspected = |a: &&Added| Finding { status: Status::Suspected, ..judge(&fitted, a).finding };
    let aside = weak.iter().map(suspected).collect();
    (Selection { reach: selection.reach, others: selection.others, ..without }, aside)
}
