//! What the flight controller says of itself, what it is, and how its IMU is mounted: what the check makes of it.

use crate::truth;
use nalgebra::{Rotation3, Vector3};
use racer::flight::motors::row;
use racer::flight::spans::{contain, length};
use racer::flight::{Log, Stream, VehicleKind};
use racer::insight::quality::{LogFinding, Quality, Severity, check};
use std::sync::OnceLock;

fn good() -> Log {
    static LOG: OnceLock<Log> = OnceLock::new();
    LOG.get_or_init(|| truth::fly(&truth::Vehicle::draw(7), 7, 100.0, 1.0)).clone()
}

fn find<'a>(quality: &'a Quality, kind: &str) -> &'a LogFinding {
    let all = &quality.findings;
    all.iter().find(|finding| finding.kind == kind).unwrap_or_else(|| panic!("no `{kind}` in {all:?}"))
}

/// A log of an IMU that lies still, as one with noise on a bench has it, for a minute.
fn bench(thrust: impl Fn(f64) -> f64) -> Log {
    let mut log = Log::default();
    for i in 0..30_000 {
        let (time, noise) = (0.002 * f64::from(i), 0.01 * f64::from(i * 37 % 11 - 5));
        log.imu.push(time, [0.1 * noise + 0.01, 0.1 * noise, -0.1 * noise, noise, -noise, 9.8 + noise]);
        log.setpoint.push(time, [0.0, 0.1 * (3.0 * time).sin(), 0.0, thrust(time)]);
    }
    log
}

#[test]
fn states_decide_what_is_flight() {
    let mut log = good();
    log.states = Stream { time_s: vec![0.0, 20.0, 40.0], rows: vec![[1.0, 0.0], [1.0, 1.0], [1.0, 0.0]] };
    let quality = check(&log);
    assert!(find(&quality, "ground").what.contains("flight controller says"), "{:?}", quality.findings);
    assert!(contain(&quality.usable, 30.0) && !contain(&quality.usable, 10.0) && !contain(&quality.usable, 41.0));
    let kept = length(&quality.usable);
    assert!((15.0..20.0).contains(&kept), "{kept}");

    // Never armed: as it flies here it was carried, or the mapping is of another log.
    log.states = Stream { time_s: vec![0.5], rows: vec![[0.0, f64::NAN]] };
    let quality = check(&log);
    assert!(quality.usable.is_empty(), "{:?}", quality.usable);
    assert!(quality.problem().unwrap().what.contains("never flies"));

    // Armed throughout says nothing of the air.
    log.states = Stream { time_s: vec![0.0], rows: vec![[1.0, f64::NAN]] };
    assert_eq!(check(&log).usable, check(&good()).usable);
}

#[test]
fn a_bench_is_no_flight_whatever_the_throttle() {
    type Throttle = fn(f64) -> f64;
    let throttles: [(&str, Throttle); 4] = [
        ("none", |_| 0.0),
        ("idle", |_| 0.05),
        ("moved", |time| 0.5 + 0.4 * (0.7 * time).sin()),
        ("not logged", |_| f64::NAN),
    ];
    for (name, throttle) in throttles {
        let quality = check(&bench(throttle));
        assert!(quality.usable.is_empty(), "{name}: {:?}", quality.usable);
        assert_eq!(quality.problem().map(|finding| finding.kind), Some("ground"), "{name}");
    }
    // Motor outputs count before the throttle stick: full stick, disarmed.
    let mut log = good();
    log.motors = Stream { time_s: log.imu.time_s.clone(), rows: vec![row(&[0.0; 4]); log.imu.len()] };
    assert!(check(&log).usable.is_empty());
}

#[test]
fn only_multirotors_are_modelled() {
    let mut log = good();
    log.vehicle.kind = Some(VehicleKind::FixedWing);
    let quality = check(&log);
    let problem = quality.problem().unwrap();
    assert!(problem.what.contains("fixed wing") && problem.stream == "vehicle", "{problem:?}");
    log.vehicle.kind = Some(VehicleKind::Multirotor);
    assert!(check(&log).problem().is_none());
}

/// The IMU's rows as one turned like this in the body has them.
fn turned(log: &mut Log, rotation_deg: [f64; 3]) {
    let [roll, pitch, yaw] = rotation_deg.map(f64::to_radians);
    let sensor = Rotation3::from_euler_angles(roll, pitch, yaw).inverse();
    for row in &mut log.imu.rows {
        let gyro = sensor * Vector3::new(row[0], row[1], row[2]);
        let force = sensor * Vector3::new(row[3], row[4], row[5]);
        row[..3].copy_from_slice(gyro.as_slice());
        row[3..].copy_from_slice(force.as_slice());
    }
}

#[test]
fn a_turned_imu_is_told_with_the_line_that_mends_it() {
    for (rotation, line) in [
        ([180.0, 0.0, 0.0], "rotation_deg = [180, 0, 0]"),
        ([0.0, 0.0, 90.0], "rotation_deg = [0, 0, 90]"),
        ([0.0, 0.0, -35.0], "rotation_deg = [0, 0, -35]"),
        ([90.0, 0.0, 45.0], "rotation_deg = [90, 0, 45]"),
    ] {
        let mut log = good();
        turned(&mut log, rotation);
        let quality = check(&log);
        let finding = find(&quality, "mounting");
        assert!(finding.severity == Severity::Problem && finding.so.contains(line), "{rotation:?}: {finding:?}");
    }
    // Without an attitude: by what was asked for, and by the thrust.
    let mut log = good();
    turned(&mut log, [0.0, 90.0, 0.0]);
    log.odometry = Stream::default();
    let quality = check(&log);
    let finding = find(&quality, "mounting");
    // Where the pitch is a right angle, roll and yaw turn alike.
    assert!(finding.so.contains(", 90, "), "{finding:?}");
}

#[test]
fn a_mirrored_gyro_and_another_attitude_are_told_apart() {
    let mut log = good();
    log.imu.rows.iter_mut().for_each(|row| row[1] = -row[1]);
    let quality = check(&log);
    let finding = find(&quality, "mounting");
    assert!(finding.what.contains("mirrored") && finding.what.contains("x is x, y is -y, z is z"), "{finding:?}");

    // An attitude between front-right-down and north-east-down, read as it is not.
    let mut log = good();
    for row in &mut log.odometry.rows {
        (row[5], row[6]) = (-row[5], -row[6]);
    }
    let quality = check(&log);
    let finding = find(&quality, "mounting");
    assert!(finding.stream == "odometry" && finding.so.contains("FRD"), "{finding:?}");
    assert!(check(&good()).findings.iter().all(|finding| finding.kind != "mounting"));
}
