//! A whole and its parts: what every sample would be the same for, and is said.

use super::finding::{Finding, Status};
use crate::insight::diagnose::motor_loop::MotorsLate;
use crate::model::effects::{self, Card, Evidence};

/// What has parts may be each by itself, of one size by chance: every rate loop is late. And it may be what only the
/// odometry's clock tells it from: every odometry is late by something of its own.
pub fn or_parts(finding: &mut Finding) {
    let Some(card) = effects::card(finding.effect) else { return };
    if finding.status != Status::Suspected && !card.parts.is_empty() {
        card.parts.iter().copied().chain(stamped(card)).for_each(|id| finding.or(id));
    }
}

/// The whole at the size of the smaller part, and the rest of the larger one, are the same to every sample: the smaller
/// one may as well be the whole, or what that is told from by the odometry's clock alone. Where the motors' outputs are
/// known, in every flight, they tell: what they have as well is no stamp, and what they do not have is no command's.
pub fn in_common(late: &[MotorsLate], findings: &mut [Finding]) {
    for whole in effects::cards().filter(|card| !card.parts.is_empty()) {
        let sure = |f: &Finding| f.status != Status::Suspected;
        // By itself, or as what another one may be.
        let said = |id: &str| findings.iter().any(|f| sure(f) && f.members.contains(&id));
        let named = |id: &&str| findings.iter().position(|f| f.effect == *id).filter(|_| said(id));
        let Some(parts) = whole.parts.iter().map(named).collect::<Option<Vec<usize>>>() else { continue };
        let size = |i: &usize| {
            let first = effects::card(findings[*i].effect).map_or("", |card| card.parameters[0].name);
            findings[*i].parameters.get(first).map_or(0.0, |value| value.value)
        };
        let smaller = parts.into_iter().min_by(|a, b| size(a).total_cmp(&size(b)));
        if let Some(i) = smaller.filter(|i| sure(&findings[*i])) {
            let (delay_s, finding) = (size(&i), &mut findings[i]);
            let any = |is: fn(&MotorsLate, f64) -> bool| late.iter().any(|l| is(l, delay_s));
            let is_thrust_s = |l: &MotorsLate, delay_s: f64| l.is_prompt(delay_s) && !l.is_behind(delay_s);
            let stamped = stamped(whole).filter(|_| !any(MotorsLate::is_before) && !any(is_thrust_s));
            let whole = Some(whole.id).filter(|_| !any(MotorsLate::is_prompt));
            whole.into_iter().chain(stamped).for_each(|id| finding.or(id));
        }
    }
}

/// What is told from `delayed` by the odometry's clock alone.
fn stamped(delayed: &Card) -> Option<&'static str> {
    effects::twins(Evidence::OdometryClock).find(|(_, other)| other.id == delayed.id).map(|(stamped, _)| stamped.id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::insight::diagnose::judgement::finding::Value;

    /// Every whole with its parts, the first of which is the smaller one.
    fn wholes() -> impl Iterator<Item = (&'static Card, Vec<Finding>)> {
        let part = |(i, id): (usize, &&str)| {
            let card = effects::card(id)?;
            let value = Value { value: 0.005 * (i + 1) as f64, low: 0.0, high: 1.0, unit: "s".into() };
            Some(Finding { parameters: [(card.parameters[0].name.into(), value)].into(), ..Finding::of(card) })
        };
        let whole = effects::cards().filter(|card| !card.parts.is_empty());
        whole.map(move |card| (card, card.parts.iter().enumerate().filter_map(part).collect()))
    }

    #[test]
    fn of_parts_the_smaller_may_be_the_whole_or_what_a_clock_tells_it_from() {
        assert!(wholes().count() > 0);
        for (whole, mut found) in wholes() {
            in_common(&[], &mut found);
            assert!(found[0].status == Status::NamedSet && found[0].members.contains(&whole.id), "{:?}", found[0]);
            assert!(stamped(whole).is_none_or(|id| found[0].members.contains(&id)), "{:?}", found[0]);
            assert!(found[1..].iter().all(|f| f.status == Status::Named), "the larger one has more than that");
            let motors = MotorsLate { outputs_s: 0.005, half: 5e-4, turns_s: 0.0 };
            let members = |motors: MotorsLate| {
                let (_, mut found) = wholes().find(|(card, _)| card.id == whole.id).expect("the same");
                in_common(&[motors], &mut found);
                found[0].members.clone()
            };
            assert_eq!(members(motors), [found[0].effect, whole.id], "commands came late");
            let prompt = MotorsLate { outputs_s: 0.0, ..motors };
            assert_eq!(members(prompt), [found[0].effect], "thrust alone is late");
            let (_, mut alone) = wholes().find(|(card, _)| card.id == whole.id).expect("the same");
            alone[1].suspect("not sure".into());
            in_common(&[], &mut alone);
            assert_eq!(alone[0].status, Status::Named, "of {}", whole.id);
        }
    }

    #[test]
    fn a_whole_may_be_its_parts_or_what_a_clock_tells_it_from() {
        for (whole, parts) in wholes() {
            let mut found = Finding::of(whole);
            or_parts(&mut found);
            assert!(parts.iter().all(|part| found.members.contains(&part.effect)), "{:?}", found.members);
            assert!(stamped(whole).is_none_or(|id| found.members.contains(&id)), "{:?}", found.members);
        }
    }
}
