//! Rules that a finding obeys, each with a log that broke it before. With `RACER_RULES=FOLDER` the logs are also
//! written, one folder a rule, for another build's `racer diagnose log.mcap --vehicle base.toml`.

use crate::truth::Vehicle;
use crate::truth::effects::Hidden;
use crate::truth::hidden::{Setting, Style, fly};
use crate::truth::other::{self, Airframe, causes};
use racer::flight::Log;
use racer::insight::diagnose::diagnose;
use racer::insight::diagnose::finding::{Diagnosis, Finding, Status};
use racer::insight::diagnose::motors;
use racer::insight::quality::check;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;

const SETTING: Setting = Setting { seed: 61, seconds: 60.0, noise: 1.0, imu_hz: 250.0, style: Style::Excited };

fn flown(vehicle: &Vehicle, effects: &[(&str, f64)]) -> Log {
    let mut rng = StdRng::seed_from_u64(61);
    let hidden: Vec<Hidden> = effects.iter().map(|(id, size)| Hidden::sized(id, *size, vehicle, &mut rng)).collect();
    fly(vehicle, &hidden, &SETTING)
}

fn said(vehicle: &Vehicle, log: &Log) -> Diagnosis {
    if let Ok(folder) = std::env::var("RACER_RULES") {
        let name = std::thread::current().name().unwrap_or("rule").replace("::", "-");
        let folder = std::path::Path::new(&folder).join(format!("{name}-{}", vehicle.mass));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("log.mcap"), racer::flight::write::mcap(log).unwrap()).unwrap();
        std::fs::write(folder.join("base.toml"), toml::to_string(&vehicle.in_racer()).unwrap()).unwrap();
    }
    diagnose(vec![check(log)], &vehicle.in_racer(), &mut |_, _| ()).diagnosis
}

/// The only name, with its delay.
fn only(diagnosis: &Diagnosis) -> (&'static str, f64) {
    let named: Vec<&Finding> = diagnosis.findings.iter().filter(|f| f.status != Status::Suspected).collect();
    let names: Vec<&str> = named.iter().map(|f| f.effect).collect();
    assert_eq!(named.len(), 1, "{names:?}");
    (named[0].effect, named[0].parameters["delay"].value)
}

/// Rule 2: one cause where one will do. It was a late gyro and a late thrust.
#[test]
fn a_whole_imu_that_is_late_is_one_cause() {
    let vehicle = Vehicle::draw(61);
    let mut log = flown(&vehicle, &[]);
    log.imu.time_s.iter_mut().for_each(|t| *t += 0.008);
    let (name, delay) = only(&said(&vehicle, &log));
    assert!(name == "imu_late" && (delay - 0.008).abs() < 5e-4, "{name} of {delay} s");
}

/// Rule 2: a link that is late is one cause. It was a delay of the rates and one of the thrust.
#[test]
fn commands_that_are_late_together_are_one_cause() {
    let vehicle = Vehicle::draw(62);
    let log = flown(&vehicle, &[("rate_delay", 0.012), ("thrust_delay", 0.012)]);
    let (name, delay) = only(&said(&vehicle, &log));
    assert!(name == "link_delay" && (delay - 0.012).abs() < 5e-4, "{name} of {delay} s");
}

/// Rule 9: a hit costs its second. It took part in every fit, and structure remained. Harder ones, such as a turn of
/// more than 5 rad/s that nobody asked for, are left out by the check already.
#[test]
fn a_hit_is_left_out_and_told() {
    let vehicle = Vehicle::draw(63);
    let mut log = flown(&vehicle, &[("rotor_drag", 0.3)]);
    let start = log.imu.time_s[0];
    for (t, row) in log.imu.time_s.iter().zip(&mut log.imu.rows) {
        if (30.2..30.5).contains(&(t - start)) {
            (row[0], row[2], row[3], row[4]) = (row[0] + 3.0, row[2] - 2.0, row[3] + 9.0, row[4] - 6.0);
        }
    }
    let diagnosis = said(&vehicle, &log);
    assert_eq!(diagnosis.left_out.len(), 1, "{:?}", diagnosis.left_out);
    let [from, to] = diagnosis.left_out[0].span_s;
    assert!(from < start + 30.2 && to > start + 30.5 && to - from < 4.0, "{from} to {to}");
    let named: Vec<&str> =
        diagnosis.findings.iter().filter(|f| f.status != Status::Suspected).map(|f| f.effect).collect();
    assert_eq!(named, ["rotor_drag"]);
    assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.headline());
    let k = diagnosis.findings[0].parameters["k"].value;
    assert!((k - 0.3).abs() < 0.03, "{k}");
}

/// Rule 10: an integrator hides a weak motor from the rates, not from what the motors are driven with.
#[test]
fn a_weak_motor_behind_an_integrator_is_named_with_its_number() {
    let airframe = Airframe::draw(64);
    let setting = Setting { seconds: 40.0, ..SETTING };
    let mut rng = StdRng::seed_from_u64(64);
    let mut hidden = causes::draw("tired_motor", 1.0, &mut rng);
    hidden.size = 0.15;
    let log = other::fly(&airframe, &[hidden], &setting);
    let driven = motors::driven(&log, &check(&log).usable);
    let weak = motors::weak(&driven, [1.0; 4]).expect("a weak motor");
    assert_eq!(weak.motor as u64, setting.seed % 4);
    assert!((weak.loss - 0.15).abs() < 0.03, "{weak:?}");
    let clean = other::fly(&airframe, &[], &setting);
    assert!(motors::weak(&motors::driven(&clean, &check(&clean).usable), [1.0; 4]).is_none());
}

/// What is named of a flight of the third truth, beside what is every vehicle's own there.
fn named_of_other(airframe: &Airframe, hidden: &[Hidden]) -> Vec<&'static str> {
    let log = other::fly(airframe, hidden, &SETTING);
    let diagnosis = said(&airframe.nominal(), &log);
    let named = diagnosis.findings.iter().filter(|f| f.status != Status::Suspected).map(|f| f.effect);
    named.filter(|name| !causes::OWN.contains(name)).collect()
}

/// A cause of the third truth.
fn cause(id: &str, size: f64) -> Hidden {
    let mut hidden = causes::draw(id, 1.0, &mut StdRng::seed_from_u64(1));
    hidden.size = size;
    hidden
}

/// Rule 1: first bend, then add. Thrust lost in climbs by another law was inflow and a vertical drag.
#[test]
fn a_form_that_the_catalogue_lacks_is_no_second_cause() {
    assert_eq!(named_of_other(&Airframe::draw(71), &[cause("inflow_root", 0.8)]), ["axial_inflow"]);
}

/// Rules 3 and 10: a vehicle with a flight controller and an estimator that is late has no fault. Its gyro was late and
/// its motors lost thrust.
#[test]
fn a_vehicle_is_not_its_fault() {
    for seed in [72, 73] {
        assert!(named_of_other(&Airframe::draw(seed), &[]).is_empty());
    }
}

/// Rule 4: estimators err in colour. Errors of the velocity that last half a second were gusts.
#[test]
fn a_slow_error_of_the_velocity_is_no_gust() {
    let vehicle = Vehicle::draw(74);
    let mut log = flown(&vehicle, &[("rotor_drag", 0.3)]);
    let mut rng = StdRng::seed_from_u64(74);
    let mut error = [0.0; 3];
    let period = 1.0 / 100.0;
    for row in &mut log.odometry.rows {
        for (k, error) in error.iter_mut().enumerate() {
            let kick: f64 = rng.sample(StandardNormal);
            *error += (-*error * period / 0.4) + 0.04 * (2.0 * period / 0.4_f64).sqrt() * kick;
            row[3 + k] += *error;
        }
    }
    assert_eq!(names(&said(&vehicle, &log)), ["rotor_drag"]);
}

/// Rule 7: small is not unexplained. A battery whose curve bends a little was structure that nobody knows.
#[test]
fn what_is_small_is_listed_and_explained() {
    let vehicle = Vehicle::draw(75);
    let diagnosis = said(&vehicle, &flown(&vehicle, &[("voltage_sag", 0.12)]));
    assert_eq!(names(&diagnosis), [""; 0]);
    assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
}

fn names(diagnosis: &Diagnosis) -> Vec<&'static str> {
    diagnosis.findings.iter().filter(|f| f.status != Status::Suspected).map(|f| f.effect).collect()
}
