//! The finding of a motor that gives less than the others.

use super::cause::MOVES;
use super::finding::{Finding, Status, Value};
use crate::insight::diagnose::motor_loop::FOUR;
use crate::insight::diagnose::prediction::motors::{Driven, Weak, weak};
use crate::model::constants::GRAVITY_M_S2;
use crate::model::effects::{self, Card, Role};
use std::collections::BTreeMap;

/// The effect that a weak motor is.
pub fn card() -> Option<&'static Card> {
    effects::acting(Role::OneMotor).next()
}

/// Where one motor gives less, by its name or by how the motors were driven, no other cause of moved thrust is sure.
pub fn doubt_moves(driven: &[Driven], findings: &mut [Finding]) {
    let named = findings.iter().any(|f| f.has(Role::OneMotor) && f.status != Status::Suspected);
    let weak = named || weak(driven, [1.0; FOUR]).is_some();
    for finding in findings.iter_mut().filter(|f| weak && f.explained.contains_key(MOVES)) {
        finding.suspect("one motor gives less, and thrust falls by that as well".into());
    }
}

/// Names the weak motor of flights that were driven like this, in the place of what the rates say of one.
pub fn name(driven: &[Driven], findings: &mut Vec<Finding>) {
    let Some((weak, card)) = weak(driven, [1.0; FOUR]).zip(card()) else { return };
    let sizes = sizes(&weak);
    if let Some(known) = findings.iter_mut().find(|f| f.effect == card.id) {
        known.parameters.extend(sizes);
        (known.status, known.why, known.members) = (Status::Named, None, vec![card.id]);
        return;
    }
    findings.push(Finding {
        channel: "motor outputs",
        parameters: sizes,
        stretches: driven.len() as f64,
        impact: impact(&weak),
        ..Finding::of(card)
    });
}

/// What its share of the thrust at hover lacks, after a second, m/s.
pub fn impact(weak: &Weak) -> f64 {
    weak.loss / FOUR as f64 * GRAVITY_M_S2
}

/// Which motor, and what it lacks.
pub fn sizes(weak: &Weak) -> BTreeMap<String, Value> {
    let number = (weak.motor + 1) as f64;
    let which = Value { value: number, low: number, high: number, unit: "in the log's order".into() };
    let Weak { loss, half, .. } = *weak;
    let lost = Value { value: loss, low: loss - half, high: loss + half, unit: "of its thrust".into() };
    BTreeMap::from([("lost".into(), lost), ("motor".into(), which)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beside_a_weak_motor_no_other_cause_of_a_move_of_thrust_is_sure() {
        let status = |harder: f64| {
            let driven: Vec<Driven> = (0..40).map(|i| [harder, 0.99, 1.0 + 0.002 * (i % 5) as f64, 1.01]).collect();
            let moves = effects::cards().find(|c| c.role != Role::OneMotor).expect("an effect");
            let said = Finding { status: Status::Named, explained: [(MOVES, 0.9)].into(), ..Finding::of(moves) };
            let other = Finding { status: Status::Named, ..Finding::of(moves) };
            let mut findings = [said, other];
            doubt_moves(&driven, &mut findings);
            findings.map(|f| f.status)
        };
        assert_eq!(status(1.2), [Status::Suspected, Status::Named]);
        assert_eq!(status(1.0), [Status::Named, Status::Named]);
    }
}
