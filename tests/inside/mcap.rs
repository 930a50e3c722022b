//! MCAP files: what racer writes, what others write, and what nobody should.

pub mod foreign;
mod hostile;

use racer::flight::mapping::Mapping;
use racer::flight::mcap::{tables, topics};
use racer::flight::motors::row;
use racer::flight::table::{LOG_TIME, Table};
use racer::flight::{Log, MOTORS, Readable, Stream, VehicleKind, VehicleRecord, write};
use std::time::Instant;

/// A log with `n` IMU samples, and fewer of the others.
pub fn log(n: usize) -> Log {
    fn stream<const N: usize>(n: usize, period_s: f64) -> Stream<N> {
        let mut stream = Stream::default();
        for i in 0..n {
            stream.push(period_s * i as f64, std::array::from_fn(|k| (i as f64 * 0.1 + k as f64).sin()));
        }
        stream
    }
    Log {
        start_ns: 5_000_000_000,
        setpoint: stream(n / 5, 0.01),
        imu: stream(n, 0.002),
        odometry: stream(n * 4 / 5, 0.0025),
        battery: stream(n / 100, 0.2),
        rotors: of_four(stream(n / 5, 0.01)),
        motors: of_four(stream(n / 5, 0.01)),
        states: Stream { time_s: vec![0.0, 1.0, 1.5], rows: vec![[1.0, f64::NAN], [1.0, 1.0], [0.0, 0.0]] },
        vehicle: VehicleRecord {
            mass_kg: Some(0.75),
            max_rate_rad_s: Some([11.5, 12.0, 6.25]),
            kind: Some(VehicleKind::FixedWing),
            rotors: Some(4),
        },
        ..Log::default()
    }
}

/// Of a vehicle with four rotors.
fn of_four(stream: Stream<4>) -> Stream<MOTORS> {
    Stream { time_s: stream.time_s, rows: stream.rows.iter().map(|numbers| row(numbers)).collect() }
}

fn columns<const N: usize>(table: &Table, names: [&str; N]) -> Vec<[f64; N]> {
    (0..table.rows()).map(|i| names.map(|name| table.columns[name][i])).collect()
}

const SETPOINT: [&str; 4] = ["body_rate.x", "body_rate.y", "body_rate.z", "thrust"];
const IMU: [&str; 6] = [
    "angular_velocity.x",
    "angular_velocity.y",
    "angular_velocity.z",
    "linear_acceleration.x",
    "linear_acceleration.y",
    "linear_acceleration.z",
];
const ODOMETRY: [&str; 10] = [
    "pose.pose.position.x",
    "pose.pose.position.y",
    "pose.pose.position.z",
    "pose.pose.orientation.w",
    "pose.pose.orientation.x",
    "pose.pose.orientation.y",
    "pose.pose.orientation.z",
    "twist.twist.linear.x",
    "twist.twist.linear.y",
    "twist.twist.linear.z",
];
const ROTORS: [&str; 4] = ["velocity[0]", "velocity[1]", "velocity[2]", "velocity[3]"];

/// Within the precision of `f32`, which some messages use.
fn assert_close<const N: usize>(found: &[[f64; N]], expected: &[[f64; N]]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!(found == expected || (found - expected).abs() < 1e-7, "{found} is not {expected}");
    }
}

#[test]
fn what_was_written_is_read() {
    let log = log(1000);
    let read = tables(&write::mcap(&log).unwrap(), &|_| true).unwrap();
    assert_eq!(read.readable, Readable::Whole);
    assert_eq!(read.vehicle, log.vehicle);
    let t = &read.tables;
    assert_eq!(columns(&t["/imu"], IMU), log.imu.rows);
    assert_eq!(columns(&t["/odom"], ODOMETRY), log.odometry.rows);
    assert_eq!(
        columns(&t["/rotors"], ROTORS),
        log.rotors.rows.iter().map(|row| row[..4].try_into().unwrap()).collect::<Vec<[f64; 4]>>()
    );
    assert_close(&columns(&t["/setpoint"], SETPOINT), &log.setpoint.rows);
    assert_close(&columns(&t["/battery"], ["voltage", "current"]), &log.battery.rows);
    for (time, expected) in t["/imu"].columns["header.stamp"].iter().zip(&log.imu.time_s) {
        assert!((time - 5.0 - expected).abs() < 1e-9);
    }
    assert_eq!(t["/imu"].columns["header.stamp"], t["/imu"].columns[LOG_TIME]);
    assert_eq!(t["/imu"].columns["orientation_covariance[0]"][0], -1.0);
}

#[test]
fn motors_rotors_and_states_come_back() {
    let log = log(1000);
    let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| a == b || a.is_nan() && b.is_nan());
    let tables = tables(&write::mcap(&log).unwrap(), &|_| true).unwrap();
    let read = Mapping::load("canonical").unwrap().apply(&tables, "a").unwrap();
    assert_eq!((read.rotors.count(), read.motors.count(), read.states.len()), (4, 4, 3));
    for (found, written) in [(&read.rotors, &log.rotors), (&read.motors, &log.motors)] {
        assert_eq!(found.len(), written.len());
        assert!(found.rows.iter().zip(&written.rows).all(|(a, b)| same(a, b)));
    }
    assert!(read.states.rows.iter().zip(&log.states.rows).all(|(a, b)| same(a, b)), "{:?}", read.states.rows);
    assert_eq!(read.vehicle, log.vehicle);
}

#[test]
fn what_was_not_measured_stays_so_and_nothing_is_repaired() {
    let mut log = Log::default();
    log.battery.push(0.0, [16.5, f64::NAN]);
    log.imu.push(1.0, [0.5; 6]);
    log.imu.push(0.5, [f64::NAN; 6]);
    log.imu.push(0.5, [0.25; 6]);
    let read = tables(&write::mcap(&log).unwrap(), &|_| true).unwrap();
    assert!(read.tables["/battery"].columns["current"][0].is_nan());
    assert_eq!(read.tables["/imu"].columns["header.stamp"], [1.0, 0.5, 0.5]);
    assert!(read.tables["/imu"].columns["angular_velocity.x"][1].is_nan());
    assert_eq!(read.tables["/imu"].columns["angular_velocity_covariance[0]"], [0.0, -1.0, 0.0]);
    assert_eq!(read.vehicle, VehicleRecord::default());
    assert!(!read.tables.contains_key("/odom"));
}

#[test]
fn times_that_ros_cannot_represent_are_an_error() {
    for time_s in [f64::NAN, f64::INFINITY, 1e300, -1e300, -1.0, 3e9] {
        let mut log = Log::default();
        log.imu.push(time_s, [0.0; 6]);
        assert!(write::mcap(&log).is_err(), "{time_s}");
    }
}

#[test]
fn topics_are_listed_and_only_wanted_ones_read() {
    let bytes = write::mcap(&log(200)).unwrap();
    let topics = topics(&bytes).unwrap();
    let names: Vec<_> = topics.iter().map(|topic| topic.name.as_str()).collect();
    assert_eq!(names, ["/battery", "/extended_state", "/imu", "/motors", "/odom", "/rotors", "/setpoint", "/state"]);
    let imu = &topics[2];
    assert_eq!((imu.message.as_str(), imu.encoding.as_str(), imu.count), ("sensor_msgs/msg/Imu", "cdr, ros2msg", 200));
    let read = tables(&bytes, &|topic| topic == "/imu").unwrap();
    assert_eq!(read.tables.keys().collect::<Vec<_>>(), ["/imu"]);
}

#[test]
fn five_minutes_are_read_in_seconds() {
    let log = log(150_000);
    let start = Instant::now();
    let bytes = write::mcap(&log).unwrap();
    let written = start.elapsed();
    let read = tables(&bytes, &|_| true).unwrap();
    let took = start.elapsed() - written;
    println!("{} MB written in {written:.1?}, read in {took:.1?}", bytes.len() / 1_000_000);
    assert_eq!(read.tables["/imu"].rows(), 150_000);
    assert!(took.as_secs() < 10, "{took:?}");
}
