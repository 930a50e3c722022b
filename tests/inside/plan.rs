//! The flight that is planned next tells apart what the flight before ties, flown in the independent simulator.

use crate::truth::Vehicle;
use crate::truth::effects::Hidden;
use crate::truth::hidden::{Setting, Style, fly_as};
use racer::flight::Log;
use racer::flight::pilot::{Manoeuvre, Pilot};
use racer::insight::diagnose::finding::{Finding, Status};
use racer::insight::diagnose::{Diagnosed, diagnose};
use racer::insight::plan::next_flight;
use racer::insight::quality::check;
use rand::SeedableRng;
use rand::rngs::StdRng;

const SEED: u64 = 61;
const HIDDEN: (&str, f64) = ("rate_thrust_coupling", 0.008);
/// None of these turns fast at a steady throttle for long.
const FEW: [Manoeuvre; 4] = [Manoeuvre::Dive, Manoeuvre::PitchSteps, Manoeuvre::ThrottleSteps, Manoeuvre::RollDoublets];

fn flown(seed: u64, seconds: f64, told: impl FnOnce(Pilot) -> Pilot) -> Log {
    let vehicle = Vehicle::draw(SEED);
    let mut rng = StdRng::seed_from_u64(SEED);
    let hidden = [Hidden::sized(HIDDEN.0, HIDDEN.1, &vehicle, &mut rng)];
    let setting = Setting { seed, seconds, noise: 1.0, imu_hz: 500.0, style: Style::Excited };
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
    let before = flown(1, 60.0, |pilot| pilot.only(&FEW));
    let first = diagnosed(&[&before]);
    let findings = &first.diagnosis.findings;
    assert!(findings.iter().any(is_open), "{findings:#?}");

    let next = next_flight(&first, &Vehicle::draw(SEED).in_racer(), &mut |_, _| ());
    assert!(next.tied && next.pairs.len() > 1, "{next:#?}");
    assert!(next.pairs.iter().flat_map(|pair| pair.causes).any(|cause| cause == Some(HIDDEN.0)), "{next:#?}");
    let told = next.pairs.iter().filter(|pair| pair.then >= pair.wanted && pair.now < pair.wanted);
    assert!(told.count() > 0, "{next:#?}");
    let plan = next.file().expect("something to fly");
    // A fast turn is what the effect is about.
    let turns = |name: &str| ["flip", "steps", "doublets", "spin"].iter().any(|part| name.contains(part));
    assert!(plan.manoeuvre.iter().any(|m| turns(&m.name) && m.count > 1), "{plan:?}");

    let after = flown(2, 1.3 * next.seconds + 20.0, |pilot| pilot.in_order(&plan.order()));
    let both = diagnosed(&[&before, &after]).diagnosis.findings;
    let named: Vec<(&str, Status)> =
        both.iter().filter(|f| f.status != Status::Suspected).map(|f| (f.effect, f.status)).collect();
    assert_eq!(named, [(HIDDEN.0, Status::Named)], "{both:#?}");
}
