//! A good log, damaged in every way that real ones are: each damage is found, named, and kept out of what is used.

use crate::truth;
use racer::flight::spans::{contain, length};
use racer::flight::{Log, Readable};
use racer::insight::quality::{LogFinding, Quality, Severity, check};
use std::sync::OnceLock;

/// Long enough for every axis to have had a manoeuvre of its own, in whichever order they come.
fn good() -> Log {
    static LOG: OnceLock<Log> = OnceLock::new();
    LOG.get_or_init(|| truth::fly(&truth::Vehicle::draw(3), 3, 100.0, 1.0)).clone()
}

fn find<'a>(quality: &'a Quality, kind: &str) -> Option<&'a LogFinding> {
    quality.findings.iter().find(|finding| finding.kind == kind)
}

/// Checks the log after `damage`; the finding of this kind must be there.
fn damaged(kind: &str, damage: impl FnOnce(&mut Log)) -> (Quality, LogFinding) {
    let mut log = good();
    damage(&mut log);
    let quality = check(&log);
    let finding = find(&quality, kind).unwrap_or_else(|| panic!("no `{kind}` in {:?}", quality.findings)).clone();
    (quality, finding)
}

#[test]
fn a_good_log_is_good() {
    let quality = check(&good());
    assert!(quality.findings.iter().all(|finding| finding.severity == Severity::Note), "{:?}", quality.findings);
    // Two seconds on the ground before, a landing after.
    let on_ground = find(&quality, "ground").unwrap().span_s.unwrap();
    assert!(on_ground[0] < 0.1 && (2.0..3.0).contains(&on_ground[1]), "{on_ground:?}");
    assert!((80.0..98.5).contains(&length(&quality.usable)), "{:?}", quality.usable);
    assert!(quality.parameters.iter().all(|parameter| parameter.why_not.is_none()), "{:?}", quality.parameters);
    let rate = |name: &str| quality.streams.iter().find(|s| s.stream == name).unwrap().rate_hz.unwrap();
    assert!((rate("imu") - 500.0).abs() < 1.0 && (rate("setpoint") - 100.0).abs() < 1.0);
}

#[test]
fn time_stamps_that_repeat_or_go_back() {
    let (quality, finding) = damaged("time_stamps", |log| {
        log.imu.time_s[500] = log.imu.time_s[499];
        log.imu.time_s[900] = log.imu.time_s[700];
        log.imu.time_s[1000] = f64::NAN;
    });
    assert_eq!(finding.stream, "imu");
    assert_eq!(quality.findings.iter().filter(|finding| finding.kind == "time_stamps").count(), 3);
    assert_eq!(quality.log.imu.len(), good().imu.len() - 3);
    assert!(quality.log.imu.time_s.is_sorted());
}

#[test]
fn a_gap_is_left_out() {
    let (quality, finding) = damaged("gap", |log| {
        let keep = |t: f64| !(20.0..21.0).contains(&t);
        let rows: Vec<_> =
            log.imu.time_s.iter().zip(&log.imu.rows).filter(|(t, _)| keep(**t)).map(|(t, row)| (*t, *row)).collect();
        (log.imu.time_s, log.imu.rows) = rows.into_iter().unzip();
    });
    let [from, to] = finding.span_s.unwrap();
    assert!((from - 20.0).abs() < 0.01 && (to - 21.0).abs() < 0.01, "{from} {to}");
    assert!(!contain(&quality.usable, 20.5) && contain(&quality.usable, 19.5));
}

#[test]
fn an_odometry_clock_that_lags_is_moved() {
    let (quality, finding) = damaged("clock_offset", |log| log.odometry.time_s.iter_mut().for_each(|t| *t += 0.02));
    assert!(finding.what.contains(" after "), "{}", finding.what);
    let moved = quality.log.odometry.time_s[0] - good().odometry.time_s[0];
    assert!(moved.abs() < 0.002, "{moved} s are left");
}

#[test]
fn held_samples_are_thinned() {
    let (quality, finding) = damaged("held_samples", |log| {
        for i in 0..log.odometry.len() {
            log.odometry.rows[i] = log.odometry.rows[i / 5 * 5];
        }
    });
    assert!(finding.what.contains("20 %"), "{}", finding.what);
    assert_eq!(quality.log.odometry.len(), good().odometry.len().div_ceil(5));
}

#[test]
fn a_crash_ends_the_flight_and_a_knock_does_not() {
    let (quality, finding) = damaged("crash", |log| {
        let at = log.imu.time_s.partition_point(|&t| t < 40.0);
        let end = log.imu.time_s.partition_point(|&t| t < 41.5);
        (at..end).for_each(|i| log.imu.rows[i][3] = 70.0);
        log.imu.time_s.truncate(end);
        log.imu.rows.truncate(end);
    });
    assert!((39.4..39.6).contains(&finding.span_s.unwrap()[0]), "{finding:?}");
    assert!(quality.usable.last().unwrap()[1] < 40.0);
    let (quality, finding) = damaged("impact", |log| log.imu.rows[15_000][4] = -60.0);
    let [from, to] = finding.span_s.unwrap();
    assert!(to - from < 1.1 && contain(&quality.usable, to + 1.0));
}

#[test]
fn a_glitch_of_the_velocity_is_told() {
    let (_, finding) = damaged("outliers", |log| log.odometry.rows[4000][8] += 54.0);
    assert!(finding.severity == Severity::Note && finding.what.starts_with("1 velocity"), "{finding:?}");
}

#[test]
fn clipping_is_left_out() {
    let (quality, finding) =
        damaged("clipping", |log| log.imu.rows.iter_mut().for_each(|row| row[5] = row[5].min(35.0)));
    assert!(finding.what.contains("specific force z") && finding.what.contains("35.0"), "{}", finding.what);
    let imu = &quality.log.imu;
    let kept = imu.time_s.iter().zip(&imu.rows).filter(|(t, row)| contain(&quality.usable, **t) && row[5] == 35.0);
    assert!(kept.count() < 20);
}

/// A pilot who only works the throttle still corrects a little, and such corrections go with anything.
#[test]
fn a_setpoint_that_hardly_moves_is_no_problem() {
    let mut log = good();
    log.setpoint.rows.iter_mut().for_each(|row| row[1] *= -0.002);
    let quality = check(&log);
    let wrong = ["sign", "swapped_axes"].map(|kind| find(&quality, kind));
    assert!(wrong.iter().all(Option::is_none), "{wrong:?}");
}

#[test]
fn swapped_signs_and_frames_are_problems() {
    let (_, finding) = damaged("sign", |log| log.setpoint.rows.iter_mut().for_each(|row| row[1] = -row[1]));
    assert!(finding.severity == Severity::Problem && finding.what.contains("pitch"), "{finding:?}");
    let (_, finding) = damaged("swapped_axes", |log| log.setpoint.rows.iter_mut().for_each(|row| row.swap(0, 1)));
    assert!(finding.what.contains("setpoint moves"), "{finding:?}");
    // An IMU in front-right-down.
    let (_, finding) = damaged("frame", |log| {
        log.imu.rows.iter_mut().for_each(|row| [1, 2, 4, 5].into_iter().for_each(|k| row[k] = -row[k]));
    });
    assert_eq!(finding.severity, Severity::Problem);
    // A velocity in the world's frame where the body's is expected, and a quaternion with its parts in another order.
    let (_, finding) = damaged("frame", |log| {
        for row in &mut log.odometry.rows {
            let q = nalgebra::Quaternion::new(row[3], row[4], row[5], row[6]);
            let v = nalgebra::UnitQuaternion::from_quaternion(q) * nalgebra::Vector3::new(row[7], row[8], row[9]);
            let v = nalgebra::UnitQuaternion::from_quaternion(q) * v;
            row[7..].copy_from_slice((-v).as_slice());
        }
    });
    assert!(finding.what.contains("velocity"), "{finding:?}");
    let (_, finding) = damaged("frame", |log| log.odometry.rows.iter_mut().for_each(|row| row[3..7].rotate_left(1)));
    assert_eq!(finding.stream, "odometry");
}

/// An attitude whose heading shows more noise than turns is right on average, and one that turns the other way is not.
#[test]
fn noise_of_the_heading_is_no_wrong_frame() {
    let noisy = |sign: f64| {
        let mut log = good();
        for (i, row) in log.odometry.rows.iter_mut().enumerate() {
            let q = nalgebra::Quaternion::new(row[3], row[4], row[5], row[6]);
            let (roll, pitch, yaw) = nalgebra::UnitQuaternion::from_quaternion(q).euler_angles();
            let off = 0.3 * (i as f64 * 2.399).sin();
            let turned = nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, sign * yaw + off);
            row[3..7].copy_from_slice(&[turned.w, turned.i, turned.j, turned.k]);
        }
        check(&log)
    };
    let wrong = |quality: &Quality| quality.findings.iter().any(|f| f.kind == "frame" && f.what.contains("yaw"));
    assert!(!wrong(&noisy(1.0)) && wrong(&noisy(-1.0)));
}

#[test]
fn what_is_missing_cannot_be_told() {
    let why = |log: &Log, name: &str| check(log).why_not(name).unwrap_or_else(|| panic!("{name} is told"));
    let without = |drop: fn(&mut Log)| {
        let mut log = good();
        drop(&mut log);
        log
    };
    assert!(why(&without(|log| log.odometry = Default::default()), "drag").contains("no velocity"));
    assert!(why(&without(|log| log.battery = Default::default()), "thrust over voltage").contains("no voltage"));
    assert!(why(&without(|log| log.setpoint = Default::default()), "yaw response").contains("no rate setpoint"));
    let still = without(|log| log.setpoint.rows.iter_mut().for_each(|row| row[2] = 0.0));
    assert!(why(&still, "yaw response").contains("hardly varies"));
    let nothing = check(&without(|log| log.imu = Default::default()));
    assert_eq!(find(&nothing, "no_imu").unwrap().severity, Severity::Problem);
    assert!(nothing.usable.is_empty());
    assert!(check(&Log::default()).usable.is_empty());
    let cut = check(&without(|log| log.readable = Readable::Prefix { bytes: 5, of: 10, why: "breaks off".into() }));
    assert!(find(&cut, "damaged_file").unwrap().what.contains("50 %"));
}

#[test]
fn a_mirrored_gyro_is_noticed() {
    for seed in 1..=6 {
        let mut log = truth::fly(&truth::Vehicle::draw(seed), seed, 60.0, 1.0);
        log.imu.rows.iter_mut().for_each(|row| row[1] = -row[1]);
        let quality = check(&log);
        let noticed = |f: &LogFinding| f.severity == Severity::Problem && f.what.contains("pitch rate goes against");
        assert!(quality.findings.iter().any(noticed), "vehicle {seed}: {:?}", quality.findings);
    }
}
