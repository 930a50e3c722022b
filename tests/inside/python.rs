//! Canonical logs, exchanged with the Python packages `mcap` and `mcap-ros2-support` in both directions.
//!
//! `RACER_PYTHON` names the interpreter (default `python3`). Where it or the packages are missing, the tests say so and
//! pass, unless `RACER_REQUIRE_PYTHON` is set.

use crate::support::python;
use racer::flight::mcap::tables;
use racer::flight::motors::row;
use racer::flight::{Log, Readable, VehicleRecord, write};
use serde_json::{Map, Value, json};
use std::path::Path;
use tempfile::TempDir;

/// The package `mcap-ros2-support`, which brings `mcap`.
const NEEDED: &str = "mcap_ros2";

fn log() -> Log {
    let mut log = Log {
        start_ns: 1_700_000_000_123_456_789,
        vehicle: VehicleRecord {
            mass_kg: Some(0.75),
            max_rate_rad_s: Some([11.5, 11.5, 7.0]),
            ..VehicleRecord::default()
        },
        ..Log::default()
    };
    for i in 0..200 {
        let (i, time_s) = (f64::from(i), 0.002 * f64::from(i));
        log.setpoint.push(time_s, [i, -0.5 * i, 0.125, 0.25]);
        log.imu.push(time_s, [0.1 * i, 0.2, 0.3, -0.1, i, 9.8]);
        log.odometry.push(time_s, [i, 2.0, 3.0, 0.5, 0.5, -0.5, 0.5, 7.0, 8.0, 9.0]);
        log.battery.push(time_s, [16.5, f64::NAN]);
        log.rotors.push(time_s, row(&[1000.0, 1001.0, 1002.0, i]));
        log.motors.push(time_s, row(&[0.25, 0.5, 0.75, 0.005 * i]));
        log.states.push(time_s, [1.0, 0.0]);
    }
    log
}

#[test]
fn python_reads_what_racer_wrote() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("log.mcap");
    std::fs::write(&path, write::mcap(&log()).unwrap()).unwrap();
    let Some(output) = python(NEEDED, &[Path::new("tests/python/read.py"), &path]) else { return };
    let read: Value = serde_json::from_slice(&output).unwrap();
    assert_eq!(read["profile"], "ros2");
    let vehicle = &read["metadata"]["racer.vehicle"];
    assert_eq!(vehicle["mass_kg"], "0.75");
    assert_eq!(vehicle["max_rate_rad_s"], "[11.5, 11.5, 7.0]");
    assert_eq!(vehicle["thrust_map"], "0..1 -> -1..1");

    let messages = read["messages"].as_array().unwrap();
    assert_eq!(messages.len(), 1600);
    let last = |topic: &str| messages.iter().rfind(|message| message["topic"] == topic).unwrap();
    let expected = [
        ("/setpoint", "mavros_msgs/msg/AttitudeTarget", "/body_rate", json!({"x": 199.0, "y": -99.5, "z": 0.125})),
        ("/setpoint", "mavros_msgs/msg/AttitudeTarget", "/thrust", json!(0.25)),
        ("/setpoint", "mavros_msgs/msg/AttitudeTarget", "/type_mask", json!(128)),
        ("/imu", "sensor_msgs/msg/Imu", "/angular_velocity", json!({"x": 0.1 * 199.0, "y": 0.2, "z": 0.3})),
        ("/imu", "sensor_msgs/msg/Imu", "/linear_acceleration", json!({"x": -0.1, "y": 199.0, "z": 9.8})),
        ("/imu", "sensor_msgs/msg/Imu", "/orientation_covariance/0", json!(-1.0)),
        ("/imu", "sensor_msgs/msg/Imu", "/header/stamp", json!({"sec": 1_700_000_000, "nanosec": 521_456_789})),
        ("/odom", "nav_msgs/msg/Odometry", "/pose/pose/position", json!({"x": 199.0, "y": 2.0, "z": 3.0})),
        ("/odom", "nav_msgs/msg/Odometry", "/pose/pose/orientation", json!({"x": 0.5, "y": -0.5, "z": 0.5, "w": 0.5})),
        ("/odom", "nav_msgs/msg/Odometry", "/twist/twist/linear", json!({"x": 7.0, "y": 8.0, "z": 9.0})),
        ("/odom", "nav_msgs/msg/Odometry", "/header/frame_id", json!("world")),
        ("/odom", "nav_msgs/msg/Odometry", "/child_frame_id", json!("base_link")),
        ("/battery", "sensor_msgs/msg/BatteryState", "/voltage", json!(16.5)),
        ("/battery", "sensor_msgs/msg/BatteryState", "/current", Value::Null),
        ("/battery", "sensor_msgs/msg/BatteryState", "/present", json!(true)),
        ("/rotors", "sensor_msgs/msg/JointState", "/velocity", json!([1000.0, 1001.0, 1002.0, 199.0])),
        ("/rotors", "sensor_msgs/msg/JointState", "/name/3", json!("rotor_3")),
        ("/motors", "actuator_msgs/msg/Actuators", "/normalized", json!([0.25, 0.5, 0.75, 0.005 * 199.0])),
        ("/state", "mavros_msgs/msg/State", "/armed", json!(true)),
        ("/extended_state", "mavros_msgs/msg/ExtendedState", "/landed_state", json!(1)),
    ];
    for (topic, name, pointer, value) in expected {
        let message = last(topic);
        assert_eq!(message["type"], name);
        assert_eq!(message["log_time"], 1_700_000_000_521_456_789_u64);
        assert_eq!(message["message"].pointer(pointer), Some(&value), "{topic} {pointer}");
    }
}

/// The schemas that racer embeds, so that both sides speak of the same messages.
fn schemas() -> Value {
    let bytes = write::mcap(&log()).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let schemas: Map<_, _> = summary
        .channels
        .values()
        .map(|channel| {
            let schema = channel.schema.as_ref().unwrap();
            let definition = str::from_utf8(&schema.data).unwrap();
            (channel.topic.clone(), json!({"type": schema.name, "definition": definition}))
        })
        .collect();
    Value::Object(schemas)
}

#[test]
fn racer_reads_what_python_wrote() {
    let dir = TempDir::new().unwrap();
    let (path, definitions) = (dir.path().join("log.mcap"), dir.path().join("schemas.json"));
    std::fs::write(&definitions, schemas().to_string()).unwrap();
    let Some(_) = python(NEEDED, &[Path::new("tests/python/write.py"), &definitions, &path]) else { return };
    let read = tables(&std::fs::read(&path).unwrap(), &|_| true).unwrap();
    assert_eq!(read.readable, Readable::Whole);
    assert_eq!(read.vehicle, log().vehicle);
    let expected = [
        ("/setpoint", "body_rate.x", 4.5),
        ("/setpoint", "thrust", 0.25),
        ("/imu", "angular_velocity.x", 0.1 * 9.0),
        ("/imu", "linear_acceleration.z", 9.75),
        ("/imu", "orientation_covariance[0]", -1.0),
        ("/odom", "pose.pose.position.x", 9.0),
        ("/odom", "pose.pose.orientation.w", 1.0),
        ("/odom", "twist.twist.linear.y", 9.0),
        ("/battery", "voltage", 16.5),
        ("/battery", "power_supply_technology", 3.0),
        ("/rotors", "velocity[3]", 409.0),
        ("/motors", "normalized[1]", 0.9),
        ("/state", "armed", 1.0),
        ("/extended_state", "landed_state", 2.0),
    ];
    for (topic, path, value) in expected {
        let table = &read.tables[topic];
        assert_eq!(table.columns[path].len(), 10);
        assert_eq!(table.columns[path][9], value, "{topic} {path}");
        let stamp = table.columns["header.stamp"][9];
        assert!((stamp - 1_700_000_000.09).abs() < 1e-6, "{stamp}");
    }
    assert!(read.tables["/battery"].columns["current"].iter().all(|current| current.is_nan()));
}
