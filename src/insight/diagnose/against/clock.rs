//! A clock that runs otherwise, and not evenly, delays signals by itself: one cause where one will do.

use super::change::Change;
use crate::insight::criteria::changed::UNEVEN_CLOCK;
use crate::insight::diagnose::judgement::finding::{Status, Value};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects::{self, Role};

/// Only suspects delays that are a small share of what clocks drift apart by over a flight, where that is named.
pub fn doubt(problem: &Problem, changes: &mut [Change]) {
    let spans = problem.records.iter().filter_map(|r| Some(r.time.last()? - r.time.first()?));
    doubt_over(spans.fold(0.0, f64::max), changes);
}

/// Over flights of so many seconds.
fn doubt_over(flight_s: f64, changes: &mut [Change]) {
    let named = |c: &Change| c.status != Status::Suspected;
    let is_clock = |c: &Change| effects::card(c.cause).is_some_and(|card| card.role == Role::ClockFast);
    let largest = |values: &mut dyn Iterator<Item = &Value>| values.map(|v| v.value.abs()).fold(0.0, f64::max);
    let clocks = changes.iter().filter(|c| named(c) && is_clock(c));
    let drift_s = clocks.map(|c| largest(&mut c.difference.values())).fold(0.0, f64::max) * flight_s;
    for change in changes.iter_mut().filter(|c| named(c) && !is_clock(c)) {
        let delay_s = largest(&mut change.difference.values().filter(|v| v.unit == "s"));
        if delay_s > 0.0 && delay_s < UNEVEN_CLOCK.get() * drift_s {
            change.status = Status::Suspected;
            let drift_ms = 1e3 * drift_s;
            change.why =
                Some(format!("the clocks drift apart by {drift_ms:.0} ms more or less: if unevenly, it is that"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_delays_beside_another_clock_are_its() {
        let stay = |delay_s: f64, skew: f64| {
            let clock = effects::cards().find(|card| card.role == Role::ClockFast).expect("a clock");
            let mut changes = [Change::sample("delay", delay_s, "s"), Change::sample(clock.id, skew, "1")];
            doubt_over(300.0, &mut changes);
            assert_eq!(changes[1].status, Status::Named);
            changes[0].status == Status::Named
        };
        assert!(!stay(-0.008, 6e-4), "8 ms of 180");
        assert!(stay(0.03, 6e-4) && stay(0.008, 1e-4), "more than an uneven clock does");
        let mut alone = [Change::sample("delay", 0.008, "s"), Change::sample("drag", 6e-4, "1")];
        doubt_over(300.0, &mut alone);
        assert_eq!(alone[0].status, Status::Named, "no clock");
    }
}
