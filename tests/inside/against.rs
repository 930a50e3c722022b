//! What changed between two flights of one vehicle: the change and nothing else, and nothing where nothing did.

use crate::truth::Vehicle;
use crate::truth::effects::Hidden;
use crate::truth::hidden::{Setting, Style, fly};
use crate::truth::other::{self, Airframe, causes};
use racer::flight::Log;
use racer::insight::diagnose::against::{Changes, compare};
use racer::insight::quality::{Quality, check};
use rand::SeedableRng;
use rand::rngs::StdRng;

/// Seeds of the vehicle and of the effects that both flights have; each flight has one of its own.
const SEED: u64 = 71;

fn flown(vehicle: &Vehicle, seed: u64, effects: &[(&str, f64)]) -> Log {
    let mut rng = StdRng::seed_from_u64(SEED);
    let hidden: Vec<Hidden> = effects.iter().map(|(id, size)| Hidden::sized(id, *size, vehicle, &mut rng)).collect();
    fly(vehicle, &hidden, &Setting { seed, seconds: 60.0, noise: 1.0, imu_hz: 250.0, style: Style::Excited })
}

fn flown_other(airframe: &Airframe, seed: u64) -> Quality {
    flown_with(airframe, seed, &[])
}

fn flown_with(airframe: &Airframe, seed: u64, hidden: &[Hidden]) -> Quality {
    let setting = Setting { seed, seconds: 60.0, noise: 1.0, imu_hz: 250.0, style: Style::Excited };
    check(&other::fly(airframe, hidden, &setting))
}

fn compared(before: &Log, after: &Log) -> Changes {
    let vehicle = Vehicle::draw(SEED).in_racer();
    compare(vec![check(before)], vec![check(after)], &vehicle, &mut |_, _| ())
}

fn named(changes: &Changes) -> Vec<&str> {
    changes.named().map(|change| change.cause).collect()
}

#[test]
fn what_both_flights_have_is_no_change() {
    let vehicle = Vehicle::draw(SEED);
    let both = [("axial_inflow", 0.6)];
    let changes = compared(&flown(&vehicle, 1, &both), &flown(&vehicle, 2, &both));
    assert!(!changes.changed && named(&changes).is_empty(), "{:?}", named(&changes));
    assert!(changes.both.iter().any(|b| b.effect == "axial_inflow"));
    let seen = changes.would_show.iter().find(|w| w.cause == "thrust").expect("the thrust can be compared");
    assert!(seen.smallest > 0.0 && seen.smallest < 0.05, "{}", seen.smallest);
}

#[test]
fn an_effect_that_came_is_named_with_its_size() {
    let vehicle = Vehicle::draw(SEED);
    let both = [("axial_inflow", 0.6)];
    let changes = compared(&flown(&vehicle, 1, &both), &flown(&vehicle, 2, &[both[0], ("rotor_drag", 0.3)]));
    assert_eq!(named(&changes), ["rotor_drag"]);
    let k = &changes.changes[0].difference["k"];
    assert!((k.value - 0.3).abs() < 0.05 && k.low > 0.0, "{k:?}");
}

/// As after a repair: the earlier flight is late, the later one is not.
#[test]
fn an_effect_that_went_is_named_with_its_size() {
    let vehicle = Vehicle::draw(SEED);
    let changes = compared(&flown(&vehicle, 1, &[("thrust_delay", 0.02)]), &flown(&vehicle, 2, &[]));
    assert_eq!(named(&changes), ["thrust_delay"]);
    let delay = &changes.changes[0].difference["delay"];
    assert!((delay.value + 0.02).abs() < 2e-3, "{delay:?}");
}

/// As after a repair of a vehicle that was identified before it: the base has what went. A late gyro was named before
/// it, and it for what that leaves.
#[test]
fn what_the_base_vehicle_has_may_go() {
    let vehicle = Vehicle::draw(SEED);
    let mut base = vehicle.in_racer();
    base.effects.sizes.insert("rate_delay".into(), [("delay".to_string(), 0.02)].into());
    let both = [("axial_inflow", 0.6)];
    let [before, after] = [flown(&vehicle, 1, &[both[0], ("rate_delay", 0.02)]), flown(&vehicle, 2, &both)];
    let changes = compare(vec![check(&before)], vec![check(&after)], &base, &mut |_, _| ());
    assert_eq!(named(&changes), ["rate_delay"]);
    let delay = &changes.changes[0].difference["delay"];
    assert!((delay.value + 0.02).abs() < 2e-3, "{delay:?}");
}

/// Another propeller: a number of the compact model, and no effect.
#[test]
fn thrust_that_is_less_is_named_as_such() {
    let vehicle = Vehicle::draw(SEED);
    let mut weaker = vehicle.clone();
    weaker.thrust_n.iter_mut().for_each(|c| *c *= 0.9);
    let changes = compared(&flown(&vehicle, 1, &[]), &flown(&weaker, 2, &[]));
    assert_eq!(named(&changes), ["thrust"]);
    let thrust = changes.changes[0].difference.values().next().expect("a size");
    let before = changes.changes[0].before.values().next().expect("a size");
    assert!((thrust.value / before.value + 0.1).abs() < 0.02, "{thrust:?} of {before:?}");
}

/// A rate loop with filters and motors that end at full is no compact model: what both flights show of it is larger
/// than the noise, and no difference.
#[test]
fn what_the_model_gets_wrong_of_both_flights_does_not_hide_a_change() {
    let airframe = Airframe::draw(SEED);
    let mut slower = airframe.clone();
    slower.max_rate = slower.max_rate.map(|rate| 0.85 * rate);
    let vehicle = airframe.nominal().in_racer();
    let changes = compare(vec![flown_other(&airframe, 1)], vec![flown_other(&slower, 2)], &vehicle, &mut |_, _| ());
    assert_eq!(named(&changes), ["full_stick_rates"]);
    let change = &changes.changes[0];
    for axis in ["roll", "pitch"] {
        let name = format!("max_rate_deg_s.{axis}");
        let share = change.difference[&name].value / change.before[&name].value;
        assert!((share + 0.15).abs() < 0.02, "{axis}: {share}");
    }
    let same = compare(vec![flown_other(&airframe, 1)], vec![flown_other(&airframe, 2)], &vehicle, &mut |_, _| ());
    assert!(!same.changed, "{:?}", named(&same));
}

/// Controllers make up for what a full battery had more: neither other propellers, nor motors that stay cool.
#[test]
fn voltage_compensation_that_came_is_named_with_its_share() {
    let airframe = Airframe::draw(SEED);
    let compensated = causes::draw("esc_voltage", 1.0, &mut StdRng::seed_from_u64(SEED));
    let size = compensated.size;
    let vehicle = airframe.nominal().in_racer();
    let [before, after] = [flown_other(&airframe, 1), flown_with(&airframe, 2, &[compensated])];
    let changes = compare(vec![before], vec![after], &vehicle, &mut |_, _| ());
    assert_eq!(named(&changes), ["voltage_compensation"]);
    let share = &changes.changes[0].difference["share"];
    assert!((share.value - size).abs() < 0.2 && share.low > 0.0, "{share:?} of {size}");
}

/// Another pack, which falls evenly: one cause, though its voltage falls less far in the mean as well.
#[test]
fn a_curved_discharge_that_went_is_named_and_no_slower_discharge_beside_it() {
    let mut airframe = Airframe::draw(SEED);
    // A minute takes all of the pack.
    airframe.discharge *= 5.0;
    let curved = causes::draw("ocv_bent", 1.0, &mut StdRng::seed_from_u64(SEED));
    let vehicle = airframe.nominal().in_racer();
    let [before, after] = [flown_with(&airframe, 1, &[curved]), flown_other(&airframe, 2)];
    let changes = compare(vec![before], vec![after], &vehicle, &mut |_, _| ());
    assert_eq!(named(&changes), ["ocv_curve"]);
    // V (3 s - 3 s2 + s3) over the flight: a parabola of three eighths of V over 1.5 beside the line.
    let bend = &changes.changes[0].difference["bend"];
    assert!(bend.high < 0.0, "{bend:?}");
}

/// Slow motors turn a vehicle as they can, whatever the gains are: rates hardly tell, what the motors are sent does.
#[test]
fn gains_of_the_rate_loop_are_named_by_the_motors() {
    let airframe = Airframe::draw(SEED);
    let mut softer = airframe.clone();
    softer.bandwidth = softer.bandwidth.map(|bandwidth| 0.6 * bandwidth);
    let vehicle = airframe.nominal().in_racer();
    let changes = compare(vec![flown_other(&airframe, 1)], vec![flown_other(&softer, 2)], &vehicle, &mut |_, _| ());
    assert_eq!(named(&changes), ["rate_gains"]);
    let change = &changes.changes[0];
    for axis in ["gain.roll", "gain.pitch"] {
        let share = change.after[axis].value / change.before[axis].value;
        assert!((share - 0.6).abs() < 0.15, "{axis}: {share}");
        let [low, high] = [change.difference[axis].low, change.difference[axis].high];
        assert!((low..high).contains(&(-0.4 * change.before[axis].value)), "{axis}: {low} to {high}");
    }
}

/// As with heavier arms: all that the rates do otherwise follows from it.
#[test]
fn turning_authority_is_named_by_the_motors_and_not_what_follows_from_it() {
    let airframe = Airframe::draw(SEED);
    let mut lazy = airframe.clone();
    lazy.authority = lazy.authority.map(|authority| 0.5 * authority);
    lazy.bandwidth = lazy.bandwidth.map(|bandwidth| 0.5 * bandwidth);
    let vehicle = airframe.nominal().in_racer();
    let changes = compare(vec![flown_other(&airframe, 1)], vec![flown_other(&lazy, 2)], &vehicle, &mut |_, _| ());
    assert_eq!(named(&changes), ["turning_authority"]);
    for (axis, value) in &changes.changes[0].difference {
        let before = changes.changes[0].before[axis].value;
        assert!((value.low..value.high).contains(&(-0.5 * before)), "{axis}: {value:?} of {before}");
    }
}
