//! Numbers that moved between two sets of flights, as a change.

use crate::insight::diagnose::against::change::Change;
use crate::insight::diagnose::judgement::finding::{Status, Value};
use crate::model::vehicle::AXES;
use std::collections::BTreeMap;

/// What a change is called; of several `members` it is a set.
pub(super) struct Words {
    pub(super) cause: &'static str,
    pub(super) name: &'static str,
    pub(super) members: Vec<&'static str>,
    pub(super) sentence: &'static str,
    /// What is measured, and in which unit.
    pub(super) number: (&'static str, &'static str),
}

/// A number about an axis (0 roll, 1 pitch, 2 yaw), before and after, each with its standard deviation.
pub(super) type Moved = (usize, [(f64, f64); 2]);

/// Standard deviations that its logarithm moved by.
pub(super) fn sure(&(_, [(a, sa), (b, sb)]): &Moved) -> f64 {
    (b / a).ln() / (sa / a).hypot(sb / b)
}

/// Of all axes together.
pub(super) fn deviations(moved: &[Moved]) -> f64 {
    moved.iter().map(|m| sure(m).powi(2)).sum::<f64>().sqrt()
}

/// The change in `words`.
pub(super) fn change(words: Words, moved: &[Moved]) -> Change {
    let Words { cause, name, members, sentence, number: (number, unit) } = words;
    let of = |f: &dyn Fn([(f64, f64); 2]) -> (f64, f64)| -> BTreeMap<String, Value> {
        let one = |&(k, sets): &Moved| {
            let (value, sd) = f(sets);
            (format!("{number}.{}", AXES[k]), Value::measured(value, sd, unit))
        };
        moved.iter().map(one).collect()
    };
    Change {
        cause,
        name,
        status: if members.len() > 1 { Status::NamedSet } else { Status::Named },
        members,
        sentence,
        before: of(&|[before, _]| before),
        after: of(&|[_, after]| after),
        difference: of(&|[(a, sa), (b, sb)]| (b - a, sa.hypot(sb))),
        deviations: deviations(moved),
        impact: None,
        why: None,
    }
}
