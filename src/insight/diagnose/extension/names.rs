//! Which names hold in the extended vehicle: each by itself, beside what is kept, and with what unseen flight says.

use crate::insight::criteria::drifted::MOVED_THRUST;
use crate::insight::criteria::unseen::STANDS_ELSEWHERE;
use crate::insight::diagnose::judgement::finding::{Finding, Status};
use crate::insight::diagnose::judgement::replication::stretches;
use crate::insight::diagnose::judgement::shown;
use crate::insight::diagnose::prediction::numbers::{THRUST, span};
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::{self, Card, CompactNumber, Role};

/// Keeps a finding that makes a channel worse out of the vehicle. What explains most of another channel is there all
/// the same, and so is what each visit of the ground shows: only its size is wrong for the next.
pub fn blame(finding: &mut Finding, why: String, worse: Option<&str>) {
    let elsewhere = |(c, share): (&&str, &f64)| Some(*c) != worse && *share > STANDS_ELSEWHERE.get();
    let by_height = effects::card(finding.effect).is_some_and(|card| card.by_height);
    if by_height || finding.explained.iter().any(elsewhere) {
        finding.why = Some(why);
    } else {
        finding.suspect(why);
    }
}

/// Whether a named finding was made a suspected one: its size is not sure beside what is kept, or may be the base's.
pub fn suspect_unsure(kept: &FittedSelection, findings: &mut [Finding]) -> bool {
    if let Some(finding) = leaning(kept, findings) {
        finding.suspect("its size is not sure without what is only suspected".into());
    } else if let Some(finding) = of_the_base(kept, findings) {
        finding.suspect("the base vehicle may be off by as much: these flights do not tell its thrust".into());
    } else {
        return false;
    }
    true
}

/// Sizes in the report are those of the extended vehicle. Lost commands are counted, and not fitted.
pub fn as_written(kept: &FittedSelection, findings: &mut [Finding]) {
    for (finding, _) in held(kept, findings) {
        let own = |(card, prefix): (&Card, String)| {
            shown::parameters(kept, card).into_iter().map(move |(name, value)| (prefix.clone() + &name, value))
        };
        finding.parameters = finding.cards().flat_map(own).collect();
    }
}

/// The least of the named findings that leans on what is only suspected.
fn leaning<'a>(kept: &FittedSelection, findings: &'a mut [Finding]) -> Option<&'a mut Finding> {
    let sure = |card| {
        let shown = stretches(kept, card);
        shown.evident() || shown.unanimous()
    };
    let unsure = held(kept, findings).filter(|(f, card)| f.cause.is_none() && !sure(card));
    unsure.map(|(finding, _)| finding).min_by(|a, b| a.impact.total_cmp(&b.impact))
}

/// What pushes by less than the thrust of a base vehicle is off by, where the flights do not tell the thrust curve.
fn of_the_base<'a>(kept: &FittedSelection, findings: &'a mut [Finding]) -> Option<&'a mut Finding> {
    let point = kept.point();
    let told = point.free.iter().any(|k| THRUST.contains(k));
    let off = MOVED_THRUST.get() * kept.problem.model.vehicle().gravity_m_s2;
    // After a second, at its size beside what is kept.
    let little = |(f, card): &(&mut Finding, &Card)| {
        let whole = f.parameters.get(card.parameters[0].name).map_or(0.0, |v| v.value);
        card.absorbed_by.contains(&CompactNumber::Thrust) && f.impact * (point.x[span(card).start] / whole).abs() < off
    };
    let mut held = held(kept, findings).filter(|(f, _)| !told && f.cause.is_none());
    held.find(little).map(|(finding, _)| finding)
}

/// Findings that are more than suspected.
pub fn named(findings: &mut [Finding]) -> impl Iterator<Item = &mut Finding> {
    findings.iter_mut().filter(|f| f.status != Status::Suspected)
}

/// The named findings that `kept` holds and fitted.
fn held<'a>(
    kept: &FittedSelection,
    findings: &'a mut [Finding],
) -> impl Iterator<Item = (&'a mut Finding, &'static Card)> {
    let cards: Vec<&'static Card> = kept.selection.added.iter().map(|a| a.card).collect();
    named(findings).filter(|f| !f.has(Role::CommandsLost)).filter_map(move |f| {
        let card = effects::card(f.effect)?;
        cards.iter().any(|held| held.id == card.id).then_some((f, card))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of an effect that explains these shares, blamed for a worse `lift`.
    fn blamed(by_height: bool, explained: &[(&'static str, f64)]) -> Finding {
        let card = effects::cards().find(|card| card.by_height == by_height).unwrap();
        let mut finding = Finding { explained: explained.iter().copied().collect(), ..Finding::of(card) };
        blame(&mut finding, "unseen flight is worse".into(), Some("lift"));
        finding
    }

    #[test]
    fn a_name_that_another_channel_or_each_visit_tells_stands_without_a_part_in_the_vehicle() {
        for (stands, by_height, explained) in [
            (true, false, &[("lift", 0.1), ("voltage", 0.8)][..]),
            (false, false, &[("lift", 0.8), ("voltage", 0.1)]),
            (true, true, &[("lift", 0.8)]),
        ] {
            let finding = blamed(by_height, explained);
            assert_eq!(finding.status == Status::Named, stands, "{explained:?}");
            assert_eq!(finding.unwritten().is_some(), stands, "{explained:?}");
            assert!(!finding.in_vehicle(), "{explained:?}");
        }
    }
}
