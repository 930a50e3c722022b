//! Effects hidden in flights of the independent simulator have to be found, and nothing where nothing is. The benchmark
//! of the same name (`cargo bench --bench hidden_effects`) does so hundreds of times.

use crate::truth::Vehicle;
use crate::truth::effects::{Hidden, outside};
use crate::truth::hidden::{Setting, Style, fly};
use nalgebra::Vector3;
use racer::insight::diagnose::judgement::diagnosis::{Diagnosis, Verdict};
use racer::insight::diagnose::judgement::finding::{Finding, Status};
use racer::insight::diagnose::{Diagnosed, diagnose};
use racer::insight::quality::check;
use rand::SeedableRng;
use rand::rngs::StdRng;

const SECONDS: f64 = 120.0;

fn setting(seed: u64) -> Setting {
    Setting { seed, seconds: SECONDS, noise: 1.0, imu_hz: 250.0, style: Style::Excited }
}

/// Two minutes of excited flight of `vehicle` with effects, diagnosed as if it had none.
fn diagnosed(vehicle: &Vehicle, hidden: &[Hidden], seed: u64) -> Diagnosed {
    let log = fly(vehicle, hidden, &setting(seed));
    diagnose(vec![check(&log)], &vehicle.in_racer(), &mut |_, _| ())
}

fn named(d: &Diagnosis) -> Vec<&Finding> {
    d.findings.iter().filter(|f| f.status != Status::Suspected).collect()
}

/// Hides effects of given sizes; all of them, and nothing else, have to be named, with the sizes within `within` of the
/// truth.
fn finds(seed: u64, effects: &[(&str, f64)], within: f64) {
    let vehicle = Vehicle::draw(seed);
    let mut rng = StdRng::seed_from_u64(seed);
    let hidden: Vec<Hidden> = effects.iter().map(|(id, size)| Hidden::sized(id, *size, &vehicle, &mut rng)).collect();
    let Diagnosed { diagnosis, .. } = diagnosed(&vehicle, &hidden, seed);
    let found = named(&diagnosis);
    let names: Vec<&str> = found.iter().map(|f| f.effect).collect();
    let all: Vec<_> = diagnosis.findings.iter().map(|f| (f.effect, &f.why, &f.parameters)).collect();
    assert_eq!(names.len(), effects.len(), "{effects:?} were hidden, {names:?} were named, found were {all:#?}");
    for truth in &hidden {
        let finding = found.iter().find(|f| f.effect == truth.id);
        let finding = finding.unwrap_or_else(|| panic!("{} was hidden, {names:?} were named", truth.id));
        for value in truth.values() {
            let estimate = &finding.parameters[value.name];
            let error = (estimate.value - value.value) / value.against;
            assert!(error.abs() < within, "{} {}: {} for {}", truth.id, value.name, estimate.value, value.value);
        }
    }
    assert_eq!(diagnosis.verdict, Verdict::Effects);
    assert!(diagnosis.captured.is_some_and(|c| c > 0.9), "captured {:?}", diagnosis.captured);
}

#[test]
fn nothing_is_found_where_nothing_is() {
    let vehicle = Vehicle::draw(41);
    let Diagnosed { diagnosis, .. } = diagnosed(&vehicle, &[], 41);
    assert_eq!(diagnosis.verdict, Verdict::Clean, "{:?}", diagnosis.findings);
    assert!(diagnosis.drift.is_empty(), "{:?}", diagnosis.drift);
}

#[test]
fn delays_are_found() {
    finds(42, &[("rate_delay", 0.012), ("thrust_delay", 0.015)], 0.03);
}

#[test]
fn yaw_has_a_delay_of_its_own() {
    finds(49, &[("rate_delay", 0.03), ("yaw_delay", -0.015)], 0.05);
}

#[test]
fn the_room_that_a_mixer_makes_is_found() {
    finds(50, &[("mixer_room", 0.06)], 0.05);
}

#[test]
fn yaw_that_swings_is_found() {
    finds(51, &[("yaw_second_order", 25.0)], 0.05);
}

#[test]
fn yaw_that_is_slow_in_large_steps_is_found() {
    finds(52, &[("yaw_slew_limit", 25.0)], 0.05);
}

#[test]
fn the_battery_is_found() {
    finds(43, &[("voltage_sag", 1.5)], 0.05);
}

#[test]
fn inflow_and_rotor_drag_are_found() {
    finds(44, &[("axial_inflow", 0.6), ("rotor_drag", 0.3)], 0.05);
}

#[test]
fn drag_by_the_speed_alone_has_no_form() {
    let vehicle = Vehicle::draw(47);
    let mut rng = StdRng::seed_from_u64(47);
    let hidden = [Hidden::sized("vertical_drag", 0.2, &vehicle, &mut rng)];
    let Diagnosed { diagnosis, .. } = diagnosed(&vehicle, &hidden, 47);
    let found = named(&diagnosis);
    assert_eq!(found.iter().map(|f| f.effect).collect::<Vec<_>>(), ["vertical_drag"]);
    assert_eq!(found[0].parameters.keys().collect::<Vec<_>>(), ["k"]);
    assert!((found[0].parameters["k"].value - 0.2).abs() < 0.01);
}

#[test]
fn a_lever_arm_corrects_the_log_and_is_no_dynamics() {
    let vehicle = Vehicle::draw(45);
    let mut rng = StdRng::seed_from_u64(45);
    let hidden = [Hidden::sized("imu_lever_arm", 0.02, &vehicle, &mut rng)];
    let Diagnosed { diagnosis, vehicle: extended, .. } = diagnosed(&vehicle, &hidden, 45);
    assert_eq!(named(&diagnosis).iter().map(|f| f.effect).collect::<Vec<_>>(), ["imu_lever_arm"]);
    let extended = extended.expect("no worse than what was given");
    assert!(extended.effects.is_empty(), "{:?}", extended.effects);
}

/// An IMU away from the centre of mass, and a velocity that is told of the same point.
#[test]
fn a_centre_of_mass_away_from_what_is_logged_is_no_lever_arm() {
    let vehicle = Vehicle::draw(45);
    let arm = Hidden::sized("imu_lever_arm", 0.02, &vehicle, &mut StdRng::seed_from_u64(45));
    let r = Vector3::from(["rx", "ry", "rz"].map(|name| arm.get(name)));
    let mut log = fly(&vehicle, &[arm], &setting(45));
    for (time, row) in log.odometry.time_s.iter().zip(&mut log.odometry.rows) {
        let at = log.imu.time_s.partition_point(|t| t <= time).clamp(1, log.imu.len()) - 1;
        let carried = Vector3::from_column_slice(&log.imu.rows[at][..3]).cross(&r);
        (0..3).for_each(|i| row[7 + i] += carried[i]);
    }
    let Diagnosed { diagnosis, .. } = diagnose(vec![check(&log)], &vehicle.in_racer(), &mut |_, _| ());
    let found = named(&diagnosis);
    assert_eq!(found.iter().map(|f| f.effect).collect::<Vec<_>>(), ["com_offset"]);
    for (i, name) in ["rx", "ry", "rz"].into_iter().enumerate() {
        assert!((found[0].parameters[name].value - r[i]).abs() < 0.002, "{name}: {}", r[i]);
    }
}

#[test]
fn what_is_not_in_the_catalogue_is_not_given_a_name() {
    let vehicle = Vehicle::draw(46);
    let mut rng = StdRng::seed_from_u64(46);
    let hidden = [outside::draw("drag_step", SECONDS, &mut rng)];
    let Diagnosed { diagnosis, .. } = diagnosed(&vehicle, &hidden, 46);
    assert_eq!(diagnosis.verdict, Verdict::Unexplained);
    let channels: Vec<&str> = diagnosis.unexplained.iter().map(|s| s.channel).collect();
    assert!(channels.contains(&"specific force x"), "{channels:?}");
    assert!(named(&diagnosis).iter().all(|f| f.channel != "specific force x"), "{:?}", named(&diagnosis));
}

#[test]
fn a_clock_that_runs_fast_is_found_and_makes_no_bias() {
    finds(47, &[("clock_skew", 0.006)], 0.01);
}

#[test]
fn a_fan_is_no_wind_and_no_gusts() {
    let vehicle = Vehicle::draw(48);
    let mut rng = StdRng::seed_from_u64(48);
    let Diagnosed { diagnosis, .. } = diagnosed(&vehicle, &[outside::draw("fan", SECONDS, &mut rng)], 48);
    assert_eq!(diagnosis.verdict, Verdict::Unexplained);
    assert!(diagnosis.unexplained.iter().any(|s| s.along == Some("place")), "{:?}", diagnosis.unexplained);
    assert!(named(&diagnosis).iter().all(|f| !["steady_wind", "gusts"].contains(&f.effect)), "{:?}", named(&diagnosis));
}
