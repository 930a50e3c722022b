//! The flight that is planned next tells apart what the flight before ties, flown in the independent simulator.

use crate::truth::Vehicle;
use crate::truth::effects::Hidden;
use crate::truth::hidden::{Setting, Style, fly_as};
use racer::flight::Log;
use racer::flight::pilot::{Manoeuvre, Pilot};
use racer::insight::diagnose::judgement::finding::{Finding, Status};
use racer::insight::diagnose::{Diagnosed, diagnose};
use racer::insight::plan::next_flight;
use racer::insight::quality::check;
use rand::SeedableRng;
use rand::rngs::StdRng;

/// A case of `cargo bench --bench hidden_effects -- --plan`, with one kind of manoeuvre less.
const SEED: u64 = 1_818_153_725_388_374_308;
const FLIGHTS: [u64; 2] = [5_923_431_025_493_652_756, 14_296_740_061_528_456_664];
const HIDDEN: (&str, f64) = ("voltage_sag", 2.138_662);
/// The throttle is closed, and hardly anything else is flown.
const FEW: [Manoeuvre; 2] = [Manoeuvre::Chop, Manoeuvre::YawSpin];

fn flown(seed: u64, seconds: f64, told: impl FnOnce(Pilot) -> Pilot) -> Log {
    let vehicle = Vehicle::draw(SEED);
    let mut rng = StdRng::seed_from_u64(SEED);
    let hidden = [Hidden::sized(HIDDEN.0, HIDDEN.1, &vehicle, &mut rng)];
    let setting = Setting { seed, seconds, noise: 0.676, imu_hz: 326.0, style: Style::Excited };
    fly_as(&vehicle, &hidden, &setting, told)
}

fn diagnosed(logs: &[&Log]) -> Diagnosed {
    let logs = logs.iter().map(|log| check(log)).collect();
    diagnose(logs, &Vehicle::draw(SEED).in_racer(), &mut |_, _| ())
}

fn is_open(finding: &Finding) -> bool {
    finding.status != Status::Named && (finding.members.contains(&HIDDEN.0) || finding.rivals.contains(&HIDDEN.0))
}

#[test]
fn the_planned_flight_tells_what_was_tied() {
    let before = flown(FLIGHTS[0], 45.0, |pilot| pilot.only(&FEW));
    let first = diagnosed(&[&before]);
    let findings = &first.diagnosis.findings;
    assert!(findings.iter().any(is_open), "{findings:#?}");

    let next = next_flight(&first, &Vehicle::draw(SEED).in_racer(), &mut |_, _| ());
    assert!(next.tied && next.pairs.len() > 1, "{next:#?}");
    assert!(next.pairs.iter().flat_map(|pair| pair.causes).any(|cause| cause == Some(HIDDEN.0)), "{next:#?}");
    let told = next.pairs.iter().filter(|pair| pair.then >= pair.wanted && pair.now < pair.wanted);
    assert!(told.count() > 0, "{next:#?}");
    let plan = next.file().expect("something to fly");
    let other = |name: &str| !FEW.iter().any(|kind| kind.name() == name) && name != "circle";
    assert!(plan.manoeuvre.iter().any(|m| other(&m.name)), "{plan:?}");

    let after = flown(FLIGHTS[1], 1.3 * next.seconds + 20.0, |pilot| pilot.in_order(&plan.order()));
    let both = diagnosed(&[&before, &after]).diagnosis.findings;
    let named: Vec<(&str, Status)> =
        both.iter().filter(|f| f.status != Status::Suspected).map(|f| (f.effect, f.status)).collect();
    assert_eq!(named, [(HIDDEN.0, Status::Named)], "{both:#?}");
}
