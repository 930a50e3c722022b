//! A motor that gives less than it did, or gives again what it lacked, by what all four are driven with.

use super::change::Change;
use crate::base::stats::NORMAL_95;
use crate::insight::diagnose::judgement::finding::{Status, Value};
use crate::insight::diagnose::judgement::one_motor::{card, impact, sizes};
use crate::insight::diagnose::prediction::motors::{Driven, Weak, middle, weak};
use crate::insight::diagnose::prediction::problem::Problem;
use std::collections::BTreeMap;

/// The change of one motor between the two sets, where both have motor outputs or rotor speeds.
pub fn find(problem: &Problem) -> Option<Change> {
    let sets = problem.contrast.as_ref()?;
    let of = |later: bool| -> Vec<Driven> {
        let flights = problem.records.iter().zip(&sets.later).filter(|(_, set)| **set == later);
        flights.flat_map(|(record, _)| record.driven.clone()).collect()
    };
    let [before, after] = [of(false), of(true)];
    let [usual_before, usual_after] = [middle(&before)?, middle(&after)?];
    let weaker = weak(&after, usual_before).map(|weak| (weak, 1.0));
    let (weak, sign) = weaker.or_else(|| Some((weak(&before, usual_after)?, -1.0)))?;
    change(weak, sign)
}

fn change(weak: Weak, sign: f64) -> Option<Change> {
    let card = card()?;
    let mut lost = sizes(&weak);
    let motor = lost.remove("motor")?;
    let zero = |v: &Value| Value { value: 0.0, low: 0.0, high: 0.0, unit: v.unit.clone() };
    let none: BTreeMap<String, Value> = lost.iter().map(|(name, v)| (name.clone(), zero(v))).collect();
    let difference = |v: &Value| {
        let (value, half) = (sign * v.value, 0.5 * (v.high - v.low));
        Value { value, low: value - half, high: value + half, unit: v.unit.clone() }
    };
    let difference = lost.iter().map(|(name, v)| (format!("{name} by motor {}", motor.value), difference(v)));
    let named = |set: BTreeMap<String, Value>| {
        set.into_iter().map(|(name, v)| (format!("{name} by motor {}", motor.value), v)).collect()
    };
    let difference = difference.collect();
    let (before, after) = if sign > 0.0 { (none, lost) } else { (lost, none) };
    Some(Change {
        cause: card.id,
        name: card.name,
        status: Status::Named,
        members: vec![card.id],
        sentence: card.sentence,
        before: named(before),
        after: named(after),
        difference,
        deviations: weak.loss / weak.half.max(1e-300) * NORMAL_95,
        impact: Some(impact(&weak)),
        why: None,
    })
}
