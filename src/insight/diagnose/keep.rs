//! What of a selection is kept: the extended vehicle's part, in which every name has to hold by itself.

use super::channels::FORCE;
use super::finding::{Finding, Status};
use super::fitted::FittedSelection;
use super::numbers::{MAX_RATE, TAU};
use super::problem::Problem;
use super::replication::stretches;
use super::select::Selection;
use super::{shown, worse};
use crate::model::effects::{self, Card, Role};

/// What of the selection is kept: what is only suspected is no part of the extended vehicle, nor what is not sure
/// without that, nor what makes unseen flight worse. With the reason where what is left is worse for all that.
pub fn keep(problem: &Problem, selection: &Selection, findings: &mut [Finding]) -> (Selection, Option<String>) {
    let mut given: Vec<usize> = Vec::new();
    loop {
        let suspected: Vec<&str> =
            findings.iter().filter(|f| f.status == Status::Suspected).map(|f| f.effect).collect();
        let kept = selection.without(problem, &suspected).with_given(problem, &given);
        let fitted = FittedSelection::new(problem, &kept);
        if let Some(finding) = leaning(&fitted, findings) {
            finding.suspect("its size is not sure without what is only suspected".into());
            continue;
        }
        let Some(worse) = worse::find(&fitted, &selection.base) else {
            return (kept, None);
        };
        let rise = format!("{} {:.0} % worse", worse.channel, 100.0 * worse.by);
        let blamed = worse.blamed.map(|card| card.id);
        let finding = findings.iter_mut().find(|f| Some(f.effect) == blamed && f.status != Status::Suspected);
        let Some(finding) = finding else {
            // No effect does it: the flights do not tell the vehicle's own numbers.
            let own = own(worse.number);
            if own.clone().any(|k| kept.point.free.contains(&k)) {
                given.extend(own);
                continue;
            }
            return (kept, Some(format!("on flight that was not used for fitting it predicts {rise}")));
        };
        finding.suspect(format!("on flight that was not used for fitting it makes {rise}"));
    }
}

/// The compact model's numbers that a rate follows its command by; nothing of other channels.
fn own(channel: usize) -> impl Iterator<Item = usize> + Clone {
    [TAU.start, MAX_RATE.start].into_iter().filter(move |_| channel < FORCE).map(move |start| start + channel)
}

/// Sizes in the report are those of the extended vehicle. Lost commands are counted, and not fitted.
pub fn as_written(kept: &FittedSelection, findings: &mut [Finding]) {
    for (finding, card) in held(kept, findings) {
        finding.parameters = shown::parameters(kept, card);
    }
}

/// The least of the named findings that leans on what is only suspected.
fn leaning<'a>(kept: &FittedSelection, findings: &'a mut [Finding]) -> Option<&'a mut Finding> {
    let unsure = held(kept, findings).filter(|(_, card)| !stretches(kept, card).evident());
    unsure.map(|(finding, _)| finding).min_by(|a, b| a.impact.total_cmp(&b.impact))
}

/// The named findings that `kept` holds and fitted.
fn held<'a>(
    kept: &FittedSelection,
    findings: &'a mut [Finding],
) -> impl Iterator<Item = (&'a mut Finding, &'static Card)> {
    let cards: Vec<&'static Card> = kept.selection.added.iter().map(|a| a.card).collect();
    let named = findings.iter_mut().filter(|f| f.status != Status::Suspected && !f.has(Role::CommandsLost));
    named.filter_map(move |f| {
        let card = effects::card(f.effect)?;
        cards.iter().any(|held| held.id == card.id).then_some((f, card))
    })
}
