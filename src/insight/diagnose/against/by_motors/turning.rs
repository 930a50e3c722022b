//! Another vehicle under the same motor outputs: they turn it by another share (its inertia, motors, propellers), or
//! later (motors that are slower, or a gyro that is). What follows from it is no change of its own.

use super::moved::{Moved, Words, change};
use crate::insight::criteria::changed::{
    AUTHORITY_ERROR, CHANGED_AUTHORITY, CHANGED_LAG, GAIN_TURNED, LAG_ERROR, SAME_AUTHORITY, YAW_TURNED,
};
use crate::insight::diagnose::against::change::Change;
use crate::insight::diagnose::judgement::finding::Status;
use crate::insight::diagnose::motor_loop::{MotorLoop, TurningPlant};
use crate::model::effects::{self, Card, EffectKind, RateResponse, ResidualChannel, Role};

const AUTHORITY: &str = "turning_authority";
/// Numbers of the compact model.
const THRUST: &str = "thrust";
const THRUST_RESPONSE: &str = "thrust_response";
const RESPONSES: [&str; 2] = ["rate_response", "yaw_response"];

/// Adds what the motors tell of the vehicle to `changes`; what follows from it is only suspected then.
pub fn replace_what_follows(loops: &[MotorLoop; 2], changes: &mut Vec<Change>) {
    if let Some(authority) = authority(loops, changes) {
        if authority.difference.len() > 1 {
            let limited = |id| effects::card(id).is_some_and(|card| card.response != RateResponse::FirstOrder);
            follow(changes, authority.name, |c| limited(c.cause) || RESPONSES.contains(&c.cause));
        }
        changes.push(authority);
    }
    if let Some(lag) = lag(loops, changes) {
        let told = |c: &Change| c.cause == THRUST_RESPONSE;
        let set = |c: &Change| c.status == Status::NamedSet && c.members.iter().any(|id| RESPONSES.contains(id));
        changes.retain(|c| !told(c));
        follow(changes, lag.name, |c| set(c) || RESPONSES.contains(&c.cause));
        changes.push(lag);
    }
}

/// What follows from a change of this `name` is no more than suspected.
fn follow(changes: &mut [Change], name: &str, follows: impl Fn(&Change) -> bool) {
    for change in changes.iter_mut().filter(|c| c.status != Status::Suspected && follows(c)) {
        change.status = Status::Suspected;
        change.why = Some(format!("the {name} explains it"));
    }
}

/// By how much the outputs turn it: about roll and pitch, or about yaw alone.
fn authority(loops: &[MotorLoop; 2], changes: &[Change]) -> Option<Change> {
    let voltage = 2.0 * (loops[1].volts / loops[0].volts).ln().abs();
    let least = (1.0 + CHANGED_AUTHORITY.get()).ln() + voltage;
    let moved = [0, 1, 2].map(|k| (loops[1].plants[k].authority / loops[0].plants[k].authority).ln());
    let told = |k: usize, share: f64| loops.iter().all(|l| l.plants[k].turned > share);
    let yaw = told(2, YAW_TURNED.get());
    let changed = |k: usize| moved[k].abs() > least && moved[k].signum() == moved[0].signum();
    // Without a voltage nothing is beyond what it may have done.
    let axes: &[usize] = match [0, 1].map(|k| told(k, GAIN_TURNED.get())) {
        [true, true] if changed(0) && changed(1) => &[0, 1, 2][..2 + usize::from(yaw)],
        [true, true] if yaw && moved[2].abs() > least => &[2],
        _ => return None,
    };
    // Propellers and motors that push by another share turn by it too.
    let thrust = changes.iter().find(|c| c.cause == THRUST && c.status != Status::Suspected);
    let pushed = thrust.and_then(|c| Some(c.after.values().next()?.value / c.before.values().next()?.value));
    if pushed.is_some_and(|share| (moved[axes[0]] - share.ln()).abs() < (1.0 + SAME_AUTHORITY.get()).ln()) {
        return None;
    }
    let of = |plant: TurningPlant| (plant.authority, plant.sd.hypot(AUTHORITY_ERROR.get() * plant.authority));
    let words = Words {
        cause: AUTHORITY,
        name: "turning authority",
        members: vec![AUTHORITY],
        sentence: "the same motor outputs turn it by another share: its inertia, its motors or its propellers",
        number: ("authority", "rad/s2 by a full output"),
    };
    Some(change(words, &moves(loops, axes, of)))
}

/// By how much later the vehicle turns than its motors are told to, about roll and pitch.
fn lag(loops: &[MotorLoop; 2], changes: &[Change]) -> Option<Change> {
    let axes = [0, 1];
    let moved = axes.map(|k| (loops[1].plants[k].lag_s / loops[0].plants[k].lag_s).ln());
    let told = axes.iter().all(|&k| loops.iter().all(|l| l.plants[k].turned > GAIN_TURNED.get()));
    let one_way = moved.iter().all(|m| m.abs() > (1.0 + CHANGED_LAG.get()).ln() && m.signum() == moved[0].signum());
    // Motors that are slower, and a gyro or an IMU that is later, look the same from here.
    let late = |card: &&Card| [Role::GyroLate, Role::ImuLate].contains(&card.role);
    let late: Vec<&str> = effects::cards().filter(late).map(|card| card.id).collect();
    let known = |c: &Change| {
        let timing = |card: &Card| card.kind == EffectKind::Timing && card.channels.contains(&ResidualChannel::Force);
        let of_thrust = |id| effects::card(id).is_some_and(timing);
        let named = c.status != Status::Suspected && c.members.iter().all(|id| *id != RESPONSES[0]);
        named && (c.cause == THRUST_RESPONSE || late.contains(&c.cause) || of_thrust(c.cause))
    };
    if !(told && one_way) || changes.iter().any(known) {
        return None;
    }
    let of = |plant: TurningPlant| (1e3 * plant.lag_s, 1e3 * LAG_ERROR.get() * plant.lag_s);
    let words = Words {
        cause: THRUST_RESPONSE,
        name: "response of the thrust",
        members: [&[THRUST_RESPONSE], &late[..]].concat(),
        sentence: "it turns later, or sooner, after its motors are told to: motors, propellers, their controllers",
        number: ("lag", "ms"),
    };
    let impact = changes.iter().find(|c| c.cause == THRUST_RESPONSE).and_then(|c| c.impact);
    Some(Change { impact, ..change(words, &moves(loops, &axes, of)) })
}

/// What is read `of` the plant of each axis.
fn moves(loops: &[MotorLoop; 2], axes: &[usize], of: impl Fn(TurningPlant) -> (f64, f64)) -> Vec<Moved> {
    axes.iter().map(|&k| (k, [0, 1].map(|set: usize| of(loops[set].plants[k])))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(authority: [f64; 3], lag_s: [f64; 3], volts: f64) -> MotorLoop {
        let plant =
            |k: usize| TurningPlant { pattern: k, lag_s: lag_s[k], authority: authority[k], sd: 2.0, turned: 0.98 };
        MotorLoop { plants: [0, 1, 2].map(plant), gains: None, volts }
    }

    fn told(before: MotorLoop, after: MotorLoop) -> Vec<Change> {
        let mut changes = Vec::new();
        replace_what_follows(&[before, after], &mut changes);
        changes
    }

    const LAGS: [f64; 3] = [0.02; 3];

    #[test]
    fn authority_is_named_beyond_what_the_voltage_may_have_done() {
        let before = || set([400.0, 380.0, 90.0], LAGS, 25.0);
        let found = told(before(), set([200.0, 190.0, 45.0], LAGS, 25.0));
        assert_eq!((found.len(), found[0].cause, found[0].difference.len()), (1, AUTHORITY, 3));
        assert_eq!(told(before(), set([400.0, 380.0, 45.0], LAGS, 25.0))[0].difference.len(), 1, "yaw alone");
        for (other, why) in [
            (set([200.0, 380.0, 90.0], LAGS, 25.0), "one of two axes"),
            (set([280.0, 266.0, 63.0], LAGS, 21.5), "a flat pack"),
            (set([200.0, 190.0, 45.0], LAGS, f64::NAN), "no voltage"),
        ] {
            assert!(told(before(), other).is_empty(), "{why}");
        }
    }

    #[test]
    fn a_lag_is_of_the_motors_or_of_the_gyro() {
        let at = |lag_s| set([400.0, 380.0, 90.0], lag_s, 25.0);
        let found = told(at(LAGS), at([0.03; 3]));
        assert_eq!((found.len(), found[0].cause, found[0].status), (1, THRUST_RESPONSE, Status::NamedSet));
        assert!(told(at(LAGS), at([0.03, 0.02, 0.02])).is_empty(), "one axis alone");
    }
}
