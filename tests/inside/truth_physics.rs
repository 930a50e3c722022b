//! The independent simulator obeys physics, the pilot keeps its box and covers the ranges, and the crate's own model
//! agrees with the simulator.

use crate::truth;
use crate::truth::{State, Vehicle, drag, integrate, thrust};
use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};
use racer::flight::Log;
use racer::flight::pilot::bounds::{HEIGHT_M, REACH_M};
use racer::model::dynamics::{self, Factors, Parameters};
use std::f64::consts::{PI, TAU};

const DT: f64 = 0.0005;

/// Aloft, level and at rest, its thrust settled at `command`.
fn aloft(vehicle: &Vehicle, command: f64) -> State {
    let response = Vector4::new(0.0, 0.0, 0.0, command);
    State { position: Vector3::new(0.0, 0.0, 1e4), response, resting: false, ..State::on_ground(vehicle) }
}

/// Smallest and largest of the numbers.
fn range(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    numbers.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// Area of the shadow that an ellipsoid casts along `n`, from the distances h of its tangents: the integral of
/// (h^2 - h'^2) / 2 around the outline.
fn shadow(semi_axes: [f64; 3], n: &Vector3<f64>) -> f64 {
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), n).expect("not opposite");
    let distance = |angle: f64| {
        let d = turn * Vector3::new(angle.cos(), angle.sin(), 0.0);
        d.component_mul(&Vector3::from(semi_axes)).norm()
    };
    let steps = 2000;
    let width = TAU / f64::from(steps);
    let part = |k: i32| {
        let angle = f64::from(k) * width;
        let slope = (distance(angle + 1e-5) - distance(angle - 1e-5)) / 2e-5;
        0.5 * (distance(angle).powi(2) - slope * slope) * width
    };
    (0..steps).map(part).sum()
}

#[test]
fn the_silhouette_is_the_shadow() {
    let semi_axes = [0.13, 0.09, 0.04];
    for n in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 2.0, 0.5], [-0.3, 0.1, 0.8]] {
        let n = Vector3::from(n).normalize();
        let (area, counted) = (drag::silhouette(semi_axes, &n), shadow(semi_axes, &n));
        assert!((area - counted).abs() < 1e-6 * area, "{n:?}: {area} {counted}");
    }
}

#[test]
fn drag_opposes_the_velocity() {
    let vehicle = Vehicle::draw(3);
    for v in [[3.0, -4.0, 12.0], [20.0, 0.0, 0.1], [0.0, 0.0, -9.0]].map(Vector3::from) {
        let force = drag::per_mass(&vehicle, &v);
        assert!(force.dot(&v) < 0.0 && force.cross(&v).norm() < 1e-12 * force.norm() * v.norm());
    }
}

#[test]
fn it_falls_at_its_terminal_velocity() {
    let vehicle = Vehicle { thrust_n: [0.0; 6], ..Vehicle::seed_class() };
    let mut state = aloft(&vehicle, -1.0);
    for _ in 0..(20.0 / DT) as usize {
        state = integrate::step(&state, &vehicle, [0.0, 0.0, 0.0, -1.0], DT);
    }
    // Flat, it shows the disk of its two longer axes.
    let disk = PI * 0.11 * 0.11;
    let terminal = (vehicle.gravity / (0.5 * vehicle.air_density * vehicle.drag_coefficient * disk)).sqrt();
    assert!((state.velocity.z + terminal).abs() < 1e-4 * terminal, "{} {terminal}", state.velocity.z);
    // What falls steadily is carried by the air.
    assert!((integrate::specific_force(&state, &vehicle).z - vehicle.gravity).abs() < 1e-3);
}

#[test]
fn it_hovers_and_rests() {
    let vehicle = Vehicle { voltage_rate: 0.0, ..Vehicle::draw(5) };
    let command = vehicle.command_for(vehicle.gravity, vehicle.full_v);
    let mut hovering = aloft(&vehicle, command);
    let mut resting = State::on_ground(&vehicle);
    for _ in 0..4000 {
        hovering = integrate::step(&hovering, &vehicle, [0.0, 0.0, 0.0, command], DT);
        resting = integrate::step(&resting, &vehicle, [0.5, 0.0, 0.0, -1.0], DT);
    }
    assert!(hovering.velocity.norm() < 1e-9, "{hovering:?}");
    assert!(resting.resting && resting.position == Vector3::zeros() && resting.rates(&vehicle) == Vector3::zeros());
    assert_eq!(integrate::specific_force(&resting, &vehicle), Vector3::new(0.0, 0.0, vehicle.gravity));
}

/// The crate's step of 0.5 ms follows the simulator for a second of wild commands within 0.1 mm, 1 mm/s and 0.001 rad.
#[test]
fn the_crates_model_agrees() {
    for seed in 0..5 {
        let vehicle = Vehicle::draw(seed);
        let parameters = Parameters::new(&vehicle.in_racer(), &Factors::NOMINAL, DT);
        let mut state = State { velocity: Vector3::new(12.0, -5.0, 3.0), ..aloft(&vehicle, 0.1) };
        state.position.z = 0.5;
        state.velocity.z = 20.0;
        let mut own = dynamics::State::new(
            state.position.into(),
            state.velocity.into(),
            [1.0, 0.0, 0.0, 0.0],
            state.response.into(),
            state.voltage,
        );
        for k in 0..2000 {
            let phase = f64::from(k / 20 * 20);
            let command = [(0.013 * phase).sin(), (0.008 * phase).cos(), (0.003 * phase).sin(), 0.3];
            state = integrate::step(&state, &vehicle, command, DT);
            dynamics::step(&mut own, &parameters, command);
        }
        let [w, i, j, k] = own.attitude;
        let turned = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k)).angle_to(&state.rotation());
        let away = (Vector3::from(own.position) - state.position).norm();
        let faster = (Vector3::from(own.velocity) - state.velocity).norm();
        assert!(away < 1e-4 && faster < 1e-3 && turned < 1e-3, "{seed}: {away} m, {faster} m/s, {turned} rad");
    }
}

/// The pilot's flight of `vehicle` without errors of the sensors.
fn flown(vehicle: &Vehicle, seed: u64) -> Log {
    truth::fly(vehicle, seed, 300.0, 0.0)
}

fn assert_in_the_box(log: &Log, name: &str) {
    let aloft = |t: f64| (8.0..282.0).contains(&t);
    let rows: Vec<_> = log.odometry.time_s.iter().zip(&log.odometry.rows).filter(|(t, _)| aloft(**t)).collect();
    for k in [0, 1] {
        let [low, high] = range(rows.iter().map(|(_, row)| row[k]));
        assert!(low > -REACH_M && high < REACH_M, "{name}: axis {k} from {low} to {high} m");
    }
    let [low, high] = range(rows.iter().map(|(_, row)| row[2]));
    // It hovers low on purpose, and does not touch the ground.
    assert!(low > 0.1 && high < HEIGHT_M[1], "{name}: height from {low} to {high} m");
    let last = log.odometry.rows.last().expect("a flight");
    assert!(last[2] < 0.01 && last[7..].iter().all(|v| v.abs() < 0.01), "{name}: it ends at {last:?}");
}

/// Every axis to 90 % of its rate and over 15 m/s in both directions, all of the throttle, most of the battery; and
/// 70 % of the rates again in the last 30 % of the flight, which identification is judged by.
#[test]
fn the_pilot_covers_what_identification_needs() {
    for seed in 0..6 {
        let vehicle = Vehicle::draw(seed);
        let log = flown(&vehicle, seed);
        assert_in_the_box(&log, &format!("vehicle {seed}"));
        for k in 0..3 {
            for (since, share) in [(0.0, 0.9), (210.0, 0.7)] {
                let rows = log.imu.time_s.iter().zip(&log.imu.rows).filter(|(t, _)| **t >= since);
                let [low, high] = range(rows.map(|(_, row)| row[k] / vehicle.max_rate[k]));
                assert!(low < -share && high > share, "{seed}: rate {k} from {low} to {high} after {since} s");
            }
        }
        let commands = log.setpoint.rows.iter().zip(&log.setpoint.time_s).filter(|(_, t)| (8.0..282.0).contains(*t));
        let [low, high] = range(commands.map(|(row, _)| 2.0 * row[3] - 1.0));
        assert!(low < -0.9 && high > 0.95, "{seed}: thrust command from {low} to {high}");
        for k in [7, 8] {
            let [low, high] = range(log.odometry.column(k));
            assert!(low < -15.0 && high > 15.0, "{seed}: velocity {k} from {low} to {high}");
        }
        let [low, high] = range(log.odometry.column(9));
        assert!(low < -10.0 && high > 14.0, "{seed}: velocity along z from {low} to {high}");
        let [low, high] = range(log.battery.column(0));
        assert!(high - low > 0.8 * (vehicle.full_v - vehicle.empty_v), "{seed}: {low} to {high} V");
    }
}

/// A flight without a low hover keeps above the floor.
#[test]
fn a_short_flight_of_the_pilot_keeps_the_floor() {
    for seed in 0..3 {
        let log = truth::fly(&Vehicle::draw(seed), seed, 190.0, 0.0);
        let rows = log.odometry.time_s.iter().zip(&log.odometry.rows).filter(|(t, _)| (8.0..172.0).contains(*t));
        let [low, _] = range(rows.map(|(_, row)| row[2]));
        assert!(low > HEIGHT_M[0], "{seed}: down to {low} m");
    }
}

/// Weak and strong, slippery and draggy vehicles stay in the box as well.
#[test]
fn the_pilot_stays_in_the_box_with_extremes() {
    let seed = Vehicle::seed_class();
    let strength = thrust::per_mass(&seed, 1.0, seed.full_v) / seed.gravity;
    for (k, ratio, drag, rates) in [
        (0, 2.6, 1.6, [400.0, 400.0, 100.0]),
        (1, 8.0, 0.2, [1000.0, 1000.0, 600.0]),
        (2, 4.0, 4.0, [618.0, 618.0, 120.0]),
    ] {
        let rate = rates.map(f64::to_radians);
        let vehicle = Vehicle {
            thrust_n: seed.thrust_n.map(|c| c * ratio / strength),
            drag_coefficient: drag,
            tau: [0.025; 4],
            max_rate: rate,
            configured_rate: rate,
            ..seed.clone()
        };
        assert_in_the_box(&flown(&vehicle, k), &format!("thrust {ratio} times the weight, drag coefficient {drag}"));
    }
}
