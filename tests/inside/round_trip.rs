//! Random vehicles, flown in the independent simulator and identified from what its sensors logged.

use crate::truth;
use racer::insight::identify::estimate::Estimated;
use racer::insight::identify::result::Identification;
use racer::insight::identify::{IdentifyOptions, identify};
use racer::insight::quality::{Severity, check};
use racer::model::dynamics::drag::ellipsoid;
use racer::model::vehicle::Vehicle;
use std::collections::BTreeMap;

/// R2 on the validation part in the paper's Table 1: roll, pitch, yaw, thrust.
const PAPER_R2: [f64; 4] = [0.994, 0.978, 0.976, 0.993];
const SECONDS: f64 = 300.0;

/// One parameter of one draw.
struct Judged {
    name: String,
    /// Relative error, its limit, and whether the 95 % interval holds the true value.
    error: f64,
    limit: f64,
    inside: bool,
}

fn options() -> IdentifyOptions {
    IdentifyOptions::new(Vehicle::load("seed_class").unwrap())
}

fn fly_and_identify(seed: u64) -> (truth::Vehicle, Identification) {
    let vehicle = truth::Vehicle::draw(seed);
    let quality = check(&truth::fly(&vehicle, seed, SECONDS, 1.0));
    let worst = quality.findings.iter().map(|finding| finding.severity).max();
    assert!(worst <= Some(Severity::Note), "nothing is wrong with this log: {:?}", quality.findings);
    (vehicle, identify(vec![quality], &options(), &mut |_, _| ()))
}

fn judge(vehicle: &truth::Vehicle, found: &Identification) -> Vec<Judged> {
    let mut out = Vec::new();
    let truth = vehicle.truth();
    let mut add = |name: String, estimate: &Estimated, truth: f64, limit: f64| {
        let value = estimate.value.unwrap_or(f64::NAN);
        let inside = estimate.interval().is_some_and(|[low, high]| (low..=high).contains(&truth));
        out.push(Judged { name, error: (value - truth) / truth, limit, inside });
    };
    for (k, axis) in ["roll", "pitch", "yaw", "thrust"].iter().enumerate() {
        add(format!("tau {axis}"), &found.response[k].tau_s, truth.time_constant_s[k], 0.05);
    }
    for (k, axis) in ["roll", "pitch", "yaw"].iter().enumerate() {
        add(format!("rate {axis}"), &found.max_rate_rad_s[k], truth.max_rate_rad_s[k], 0.01);
    }
    for (k, axis) in ["x", "y", "z"].iter().enumerate() {
        add(format!("drag {axis}"), &found.drag.k_1_m[k], truth.drag_per_m[k], 0.1);
    }
    // Each coefficient has an interval; what counts is the curve, below.
    for k in 0..6 {
        add(format!("thrust c{k}"), &found.thrust_n[k], vehicle.thrust_n[k], f64::INFINITY);
    }
    add("discharge".into(), &found.battery.rate_v_s, truth.voltage[1], 0.02);
    out.push(Judged { name: "thrust curve".into(), error: curve_error(vehicle, found), limit: 0.01, inside: true });
    out
}

/// Largest error of the thrust over what was flown of command and voltage, as a share of full thrust.
fn curve_error(vehicle: &truth::Vehicle, found: &Identification) -> f64 {
    let c: Vec<f64> = found.thrust_n.iter().map(|c| c.value.unwrap()).collect();
    let [from, to] = found.flown.unwrap();
    let mut worst: f64 = 0.0;
    for i in 0..=50 {
        for volts in [vehicle.full_v, vehicle.full_v + SECONDS * vehicle.voltage_rate] {
            let u = from + (to - from) * f64::from(i) / 50.0;
            let thrust = c[0] + c[1] * u + c[2] * u.powi(2) + c[3] * u.powi(3) + c[4] * volts + c[5] * u * volts;
            worst = worst.max((thrust / vehicle.mass - truth::thrust::per_mass(vehicle, u, volts)).abs());
        }
    }
    worst / truth::thrust::per_mass(vehicle, 1.0, vehicle.full_v)
}

#[test]
fn a_random_vehicle_is_found_again() {
    // The six coefficients of the thrust move together, so that one unlucky flight loses several: both flights are
    // counted.
    let (mut inside, mut all) = (0, 0);
    for seed in [1, 2] {
        let (vehicle, found) = fly_and_identify(seed);
        let judged = judge(&vehicle, &found);
        for j in &judged {
            assert!(j.error.abs() < j.limit, "vehicle {seed}: {} is off by {:.2} %", j.name, 100.0 * j.error);
        }
        let missed: Vec<&str> = judged.iter().filter(|j| !j.inside).map(|j| j.name.as_str()).collect();
        let others = missed.iter().filter(|name| !name.starts_with("thrust c")).count();
        assert!(others <= 3, "vehicle {seed}: {missed:?} lie outside");
        (inside, all) = (inside + judged.iter().filter(|j| j.inside).count(), all + judged.len());
        for (k, paper) in PAPER_R2.into_iter().enumerate() {
            let r2 = found.response[k].r2.unwrap();
            assert!(r2 >= paper, "vehicle {seed}, response {k}: R2 {r2}, in the paper {paper}");
        }
        assert!(found.remarks.is_empty(), "{:?}", found.remarks);
        // The file carries all of it, and reads back.
        let text = toml::to_string(&found.vehicle).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("v.toml");
        std::fs::write(&path, text).unwrap();
        let read = Vehicle::load(path.to_str().unwrap()).unwrap();
        assert_eq!(read, found.vehicle);
        assert_eq!(read.mass_kg, vehicle.mass);
        assert!(read.identified.unwrap().interval.contains_key("time_constant_s.roll"));
    }
    assert!(4 * inside >= 3 * all, "{inside} of {all} intervals hold");
}

/// What a flight without velocity cannot tell is lent in proportion to the mass: drag of a vehicle of 1 kg on one of 50
/// g was thirty times too much, and its thrust curve did not predict.
#[test]
fn a_light_vehicle_is_lent_no_heavy_ones_drag() {
    let mut log = truth::fly(&truth::Vehicle::draw(5), 5, 60.0, 1.0);
    log.odometry.rows.iter_mut().for_each(|row| row[7..].fill(f64::NAN));
    let of = |mass_kg| {
        let options = IdentifyOptions { mass_kg: Some(mass_kg), ..options() };
        identify(vec![check(&log)], &options, &mut |_, _| ()).vehicle
    };
    let (light, heavy) = (of(0.05), of(1.0));
    assert!(heavy.identified.as_ref().unwrap().assumed.contains_key("drag"));
    let per_mass = |v: &Vehicle| [v.thrust_at(1.0, v.battery.full_v), ellipsoid(&v.drag)[0]].map(|x| x / v.mass_kg);
    let ratios: Vec<f64> = per_mass(&light).iter().zip(per_mass(&heavy)).map(|(a, b)| a / b).collect();
    assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() < 1e-6), "{ratios:?}");
}

/// `cargo test --test inside -- --ignored round_trip::write`: a log to try `racer identify` on, and the vehicle that
/// flew it, in target/truth.
#[test]
#[ignore = "writes files"]
fn write_a_log_and_its_vehicle() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("target/truth");
    std::fs::create_dir_all(&folder).unwrap();
    let vehicle = truth::Vehicle::draw(7);
    let log = racer::flight::write::mcap(&truth::fly(&vehicle, 7, SECONDS, 1.0)).unwrap();
    std::fs::write(folder.join("flight.mcap"), log).unwrap();
    std::fs::write(folder.join("true.toml"), toml::to_string(&vehicle.in_racer()).unwrap()).unwrap();
}

/// `cargo test --test inside -- --ignored --nocapture round_trip::many`, with the number of vehicles in
/// DRAWS (default 40).
#[test]
#[ignore = "minutes; its table is in RESULTS.md"]
fn many_draws() {
    let draws: u64 = std::env::var("DRAWS").map_or(40, |n| n.parse().unwrap());
    let mut table: BTreeMap<String, Vec<Judged>> = BTreeMap::new();
    let mut r2 = [f64::INFINITY; 4];
    for seed in 101..101 + draws {
        let (vehicle, found) = fly_and_identify(seed);
        for (lowest, response) in r2.iter_mut().zip(&found.response) {
            *lowest = lowest.min(response.r2.unwrap());
        }
        for j in judge(&vehicle, &found) {
            table.entry(j.name.clone()).or_default().push(j);
        }
        println!("vehicle {seed} done");
    }
    println!("{:<16}{:>14}{:>14}{:>10}", "parameter", "median, %", "worst, %", "inside");
    let (mut held, mut all) = (0, 0);
    for (name, judged) in &table {
        let mut errors: Vec<f64> = judged.iter().map(|j| 100.0 * j.error.abs()).collect();
        errors.sort_by(f64::total_cmp);
        let inside = judged.iter().filter(|j| j.inside).count();
        println!(
            "{name:<16}{:>14.3}{:>14.3}{inside:>7}/{}",
            errors[errors.len() / 2],
            errors[errors.len() - 1],
            judged.len()
        );
        assert!(judged.iter().all(|j| j.error.abs() < j.limit), "{name}");
        if name != "thrust curve" {
            held += inside;
            all += judged.len();
        }
    }
    println!("95 % intervals that hold the true value: {held} of {all}, {:.1} %", 100.0 * held as f64 / all as f64);
    println!("lowest validation R2: roll {:.4}, pitch {:.4}, yaw {:.4}, thrust {:.4}", r2[0], r2[1], r2[2], r2[3]);
    assert!((0.92..0.985).contains(&(held as f64 / all as f64)));
}
