//! A delay of all commands and an IMU that is stamped late look alike: the odometry, which then seems early by as much,
//! tells them apart.

use super::change::Change;
use crate::base::stats::mean;
use crate::insight::criteria::changed::{SAME_ODOMETRY_S, SAME_ODOMETRY_SHARE};
use crate::insight::diagnose::judgement::finding::Status;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects::{self, Card, Evidence, Role};

/// Calls delays what the odometry says they are, with the numbers `x`; a set where it does not tell.
pub fn tell(problem: &Problem, x: &[f64], changes: &mut [Change]) {
    let Some(early_s) = early(problem, x) else { return };
    for (stamped, delayed) in effects::twins(Evidence::OdometryClock) {
        for change in changes.iter_mut().filter(|c| c.cause == delayed.id && c.status != Status::Suspected) {
            rename(change, stamped, delayed, early_s);
        }
    }
}

/// By how much the odometry comes earlier, against the gyro, in the later flights, s.
fn early(problem: &Problem, x: &[f64]) -> Option<f64> {
    let contrast = problem.contrast.as_ref()?;
    let moved = |later: bool| -> Vec<f64> {
        let of = contrast.moved_s.iter().zip(&contrast.later).filter(|(_, set)| **set == later);
        of.map(|(moved, _)| *moved).collect()
    };
    let late: f64 =
        effects::acting(Role::OdometryLate).filter_map(|card| Some(x[contrast.of(span(card).start)?])).sum();
    Some(mean(&moved(true)) - mean(&moved(false)) - late)
}

fn rename(change: &mut Change, stamped: &'static Card, delayed: &'static Card, early_s: f64) {
    let by: f64 = change.difference.values().map(|v| v.value).sum();
    let is = |expected: f64| (early_s - expected).abs() <= SAME_ODOMETRY_S.get() + SAME_ODOMETRY_SHARE.get() * by.abs();
    let members: &[&Card] = match (is(0.0), is(by)) {
        (true, false) => &[],
        (false, true) => &[stamped],
        _ => &[delayed, stamped],
    };
    let Some(first) = members.first() else { return };
    (change.cause, change.name, change.sentence) = (first.id, first.name, first.sentence);
    change.members.retain(|id| ![stamped.id, delayed.id].contains(id));
    change.members.splice(0..0, members.iter().map(|card| card.id));
    change.status = if change.members.len() > 1 { Status::NamedSet } else { Status::Named };
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A delay of all commands by 20 ms, with a rival of it.
    fn delay(delayed: &Card) -> Change {
        let status = Status::NamedSet;
        let members = vec![delayed.id, "rival"];
        Change { name: delayed.name, status, members, ..Change::sample(delayed.id, 0.02, "s") }
    }

    #[test]
    fn the_odometry_tells_late_stamps_from_late_commands() {
        let (stamped, delayed) = effects::twins(Evidence::OdometryClock).next().expect("twins");
        let told = |early_s: f64| {
            let mut change = delay(delayed);
            rename(&mut change, stamped, delayed, early_s);
            (change.name, change.members)
        };
        assert_eq!(told(0.002), (delayed.name, vec![delayed.id, "rival"]), "on time: late commands");
        assert_eq!(told(0.018), (stamped.name, vec![stamped.id, "rival"]), "early by as much: late stamps");
        assert_eq!(told(0.01), (delayed.name, vec![delayed.id, stamped.id, "rival"]), "early by half: either");
        let mut alone = delay(delayed);
        alone.members.truncate(1);
        rename(&mut alone, stamped, delayed, 0.02);
        assert_eq!((alone.cause, alone.status), (stamped.id, Status::Named));
    }
}
