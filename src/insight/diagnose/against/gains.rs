//! Other gains of the flight controller's rate loop, by what it sends to the motors. The rates themselves hardly show
//! them: motors that are slow, or at an end of their range, turn the vehicle as they can.

use super::change::Change;
use crate::base::stats::NORMAL_95;
use crate::insight::criteria::changed::{
    CHANGED_GAIN, GAIN_ANSWERED, GAIN_DEVIATIONS, GAIN_ERROR, GAIN_TURNED, GAINS_DEVIATIONS, SAME_AUTHORITY, SAME_LAG,
    SAME_LOOP_DELAY_S,
};
use crate::insight::diagnose::finding::{Status, Value};
use crate::insight::diagnose::rate_gains::{AXES, RateGain};
use std::collections::BTreeMap;

const NAMES: [&str; AXES] = ["roll", "pitch"];

/// Whether a flight is one of the later, and its gains.
pub type FlightGains = (bool, Option<[RateGain; AXES]>);

/// The compact model's number that follows from these gains.
const RESPONSE: &str = "rate_response";

/// What changed of the gains, in the place of the response of roll and pitch in `changes`. Yaw's stays: its gains are
/// not looked at.
pub fn replace_response(flights: &[FlightGains], changes: &mut Vec<Change>) {
    let Some(gains) = find(flights) else { return };
    let response = changes.extract_if(.., |c| c.cause == RESPONSE);
    let impact = response.filter_map(|c| c.impact).last();
    changes.push(Change { impact, ..gains });
}

/// Gains of roll and pitch that both moved one way, where nothing else of the loop did.
fn find(flights: &[FlightGains]) -> Option<Change> {
    let set = |later: bool, k: usize| {
        let flights = flights.iter().filter(|(set, _)| *set == later);
        RateGain::together(&flights.map(|(_, gains)| Some((*gains)?[k])).collect::<Option<Vec<RateGain>>>()?)
    };
    let pairs: Option<Vec<_>> = (0..AXES).map(|k| Some([set(false, k)?, set(true, k)?])).collect();
    changed(&pairs?)
}

/// The change of each axis' gain from one set to the other.
fn changed(pairs: &[[RateGain; 2]]) -> Option<Change> {
    let moved: Vec<f64> = pairs.iter().map(|[a, b]| (b.gain / a.gain).ln()).collect();
    let sd = |[a, b]: &[RateGain; 2]| (error(a) / a.gain).hypot(error(b) / b.gain);
    let sure: Vec<f64> = moved.iter().zip(pairs).map(|(moved, pair)| moved / sd(pair)).collect();
    let one_way = moved.iter().all(|m| m.signum() == moved[0].signum() && m.abs() > (1.0 + CHANGED_GAIN.get()).ln());
    let deviations = sure.iter().map(|s| s * s).sum::<f64>().sqrt();
    let evident = sure.iter().all(|s| s.abs() > GAIN_DEVIATIONS.get()) && deviations > GAINS_DEVIATIONS.get();
    if !(one_way && evident && pairs.iter().all(told)) {
        return None;
    }
    let value = |value: f64, sd: f64| {
        let half = NORMAL_95 * sd;
        Value { value, low: value - half, high: value + half, unit: "of the most of a motor, per rad/s".into() }
    };
    let of = |f: &dyn Fn(&[RateGain; 2]) -> Value| -> BTreeMap<String, Value> {
        NAMES.iter().zip(pairs).map(|(name, pair)| (format!("gain.{name}"), f(pair))).collect()
    };
    Some(Change {
        cause: "rate_gains",
        name: "gains of the rate loop",
        status: Status::Named,
        members: vec!["rate_gains"],
        sentence: "the flight controller answers an error of roll and pitch with more or less: its gains",
        before: of(&|[a, _]| value(a.gain, error(a))),
        after: of(&|[_, b]| value(b.gain, error(b))),
        difference: of(&|[a, b]| value(b.gain - a.gain, error(a).hypot(error(b)))),
        deviations,
        impact: None,
        why: None,
    })
}

/// Standard deviation of a gain, with what the spread over the time of a flight does not show.
fn error(g: &RateGain) -> f64 {
    g.sd.hypot(GAIN_ERROR.get() * g.gain)
}

/// Whether both sets tell the gain, and have the same vehicle and the same delay about it: where another authority,
/// other motors or another filter are at work the outputs are others with the same gains.
fn told([a, b]: &[RateGain; 2]) -> bool {
    let known = |g: &RateGain| g.turned > GAIN_TURNED.get() && g.answered > GAIN_ANSWERED.get();
    let same = |x: f64, y: f64, within: f64| (x / y).ln().abs() < (1.0 + within).ln();
    known(a)
        && known(b)
        && same(a.authority, b.authority, SAME_AUTHORITY.get())
        && same(a.lag_s, b.lag_s, SAME_LAG.get())
        && (a.delay_s - b.delay_s).abs() < SAME_LOOP_DELAY_S.get()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(gain: f64) -> RateGain {
        RateGain { gain, sd: 0.003, authority: 400.0, lag_s: 0.03, delay_s: 0.0, turned: 0.98, answered: 0.99 }
    }

    #[test]
    fn named_where_both_axes_say_it_and_the_vehicle_is_the_same() {
        let pair = |before: RateGain, after: RateGain| [before, after];
        let less = pair(axis(0.15), axis(0.09));
        let found = changed(&[less, pair(axis(0.13), axis(0.08))]).expect("gains");
        assert!((found.difference["gain.roll"].value + 0.06).abs() < 1e-12 && found.deviations > 7.0, "{found:?}");
        assert!(changed(&[less, pair(axis(0.13), axis(0.12))]).is_none(), "one axis alone");
        assert!(changed(&[less, pair(axis(0.09), axis(0.15))]).is_none(), "one up, one down");
        for other in [
            RateGain { authority: 300.0, ..axis(0.09) },
            RateGain { lag_s: 0.02, ..axis(0.09) },
            RateGain { delay_s: 0.008, ..axis(0.09) },
            RateGain { turned: 0.5, ..axis(0.09) },
            RateGain { answered: 0.9, ..axis(0.09) },
            RateGain { sd: 0.03, ..axis(0.09) },
        ] {
            assert!(changed(&[pair(axis(0.15), other), less]).is_none(), "{other:?}");
        }
    }
}
