//! Flight that no fit has seen, and flips that go further than half a turn between two looks of the odometry.

use crate::truth::Vehicle;
use crate::truth::effects::{Hidden, log_range};
use crate::truth::hidden::{Setting, Style, fly_as};
use racer::flight::pilot::Manoeuvre;
use racer::insight::diagnose::diagnose;
use racer::insight::diagnose::judgement::diagnosis::Diagnosis;
use racer::insight::diagnose::judgement::finding::Status;
use racer::insight::quality::check;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Two flights of a vehicle of `cargo bench --bench hidden_effects -- --plan --seed 6`, with an effect, diagnosed
/// together.
fn both(case: u64, (id, size): (&str, f64), few: &[Manoeuvre], next: &[(Manoeuvre, usize)], next_s: f64) -> Diagnosis {
    let seed = 6_u64.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ case.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mut rng = StdRng::seed_from_u64(seed);
    let vehicle = Vehicle::draw(rng.random());
    let noise = log_range(&mut rng, 0.5, 2.0);
    let imu_hz = log_range(&mut rng, 200.0, 1000.0).round();
    let hidden = [Hidden::sized(id, size, &vehicle, &mut StdRng::seed_from_u64(seed))];
    let mut setting = |seconds| Setting { seed: rng.random(), seconds, noise, imu_hz, style: Style::Excited };
    let [first, second] = [setting(45.0), setting(next_s)];
    let order: Vec<Manoeuvre> = next.iter().flat_map(|(kind, times)| vec![*kind; *times]).collect();
    let logs = [
        fly_as(&vehicle, &hidden, &first, |pilot| pilot.only(few)),
        fly_as(&vehicle, &hidden, &second, |pilot| pilot.in_order(&order)),
    ];
    diagnose(logs.iter().map(check).collect(), &vehicle.in_racer(), &mut |_, _| ()).diagnosis
}

fn named(d: &Diagnosis) -> Vec<&str> {
    d.findings.iter().filter(|f| f.status == Status::Named).map(|f| f.effect).collect()
}

/// At 840 deg/s a flip goes 3.7 rad within a quarter of a second.
#[test]
fn a_fast_flip_is_told_the_way_round_that_was_flown() {
    let few = [Manoeuvre::Right, Manoeuvre::RollSteps, Manoeuvre::RampDown];
    let next = [(Manoeuvre::RollFlip, 30), (Manoeuvre::Circle, 1)];
    let d = both(118, ("velocity_lag", 0.0265), &few, &next, 112.0);
    assert_eq!(named(&d), ["velocity_lag"], "{:#?}", d.findings);
    assert!(d.residuals["turn x"].before < 0.02, "{:?}", d.residuals["turn x"]);
}

/// What a short flight knows is no measure of what a long one shows.
#[test]
fn a_flight_that_holds_most_is_unseen_by_thirds() {
    let next = [(Manoeuvre::Circle, 8), (Manoeuvre::RollFlip, 2)];
    let d = both(102, ("accel_scale", -0.013), &[Manoeuvre::PitchDoublets], &next, 110.0);
    assert_eq!(named(&d), ["accel_scale"], "{:#?}", d.findings);
}
