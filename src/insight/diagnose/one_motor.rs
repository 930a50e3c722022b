//! The finding of a motor that gives less than the others.

use super::finding::{Finding, Status, Value};
use super::motors::{Driven, FOUR, Weak, weak};
use crate::model::constants::GRAVITY_M_S2;
use crate::model::effects::{self, Card, Role};
use std::collections::BTreeMap;

/// The effect that a weak motor is.
pub fn card() -> Option<&'static Card> {
    effects::acting(Role::OneMotor).next()
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
