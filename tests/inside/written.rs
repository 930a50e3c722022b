//! What racer writes, racer reads: vehicles identified from flights that tell little or contradict physics.

use crate::truth;
use racer::flight::{Log, motors};
use racer::insight::identify::{IdentifyOptions, identify, refuse};
use racer::insight::quality::check;
use racer::model::vehicle::Vehicle;
use racer::model::vehicle::identified::Origin;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Identifies, and reads what would be written, whether or not it would be refused.
fn written(log: &Log) -> (Vehicle, bool) {
    let options = IdentifyOptions::new(Vehicle::load("seed_class").unwrap());
    let found = identify(vec![check(log)], &options, &mut |_, _| ());
    let folder = tempfile::tempdir().unwrap();
    for (name, vehicle) in [("all", &found.vehicle), ("training", &found.validated)] {
        let path = folder.path().join(name);
        std::fs::write(&path, toml::to_string(vehicle).unwrap()).unwrap();
        let read = Vehicle::load(path.to_str().unwrap()).unwrap_or_else(|e| panic!("{name}: {e}\n{vehicle:?}"));
        assert_eq!(&read, vehicle);
    }
    let identified = found.vehicle.identified.as_ref().unwrap();
    for key in identified.interval.keys() {
        assert_eq!(identified.origin.get(key), Some(&Origin::Log), "an interval of `{key}`, which is not the log's");
    }
    let whole = refuse::nothing(&found, false).is_ok();
    assert!(whole || refuse::nothing(&found, false).unwrap_err().to_string().contains("--partial"));
    (found.vehicle, whole)
}

/// Flights with their thrust command and specific force spoiled at random: scaled, turned over, flat, noise.
#[test]
fn every_vehicle_is_read_back() {
    let mut rng = StdRng::seed_from_u64(8);
    let truth = truth::Vehicle::draw(3);
    let whole = truth::fly(&truth, 3, 60.0, 1.0);
    let (mut kept, mut refused) = (0, 0);
    for case in 0..12 {
        let mut log = whole.clone();
        let (force, command) = (rng.random_range(-1.5..1.5), rng.random_range(-1.0..1.0));
        let noise = if case % 3 == 0 { 8.0 } else { 0.0 };
        for row in &mut log.imu.rows {
            row[5] = if case % 4 == 1 { 9.8 } else { force * row[5] } + noise * rng.random_range(-1.0..1.0);
        }
        if case % 2 == 0 {
            log.setpoint.rows.iter_mut().for_each(|row| row[3] = 0.5 + command * (row[3] - 0.5));
        }
        if case % 5 == 0 {
            log.battery = Default::default();
        }
        let (vehicle, fine) = written(&log);
        assert!(vehicle.thrust_to_weight() > 1.0);
        *(if fine { &mut kept } else { &mut refused }) += 1;
    }
    assert!(refused > 3, "{kept} kept and {refused} refused");
}

/// A battery belongs to the thrust curve over its voltage: where one is lent, so is the other, for its own mass.
#[test]
fn a_lent_thrust_curve_keeps_its_own_pack() {
    let truth = truth::Vehicle::draw(4);
    let mut log = truth::fly(&truth, 4, 60.0, 1.0);
    // Motor outputs of a bench: they say nothing of the flight.
    let mut rng = StdRng::seed_from_u64(1);
    for t in log.imu.time_s.clone() {
        log.motors.push(t, motors::row(&[0, 1, 2, 3].map(|_| rng.random_range(0.2..0.9))));
    }
    let (vehicle, fine) = written(&log);
    let base = Vehicle::load("seed_class").unwrap().with_mass(vehicle.mass_kg);
    assert!(!fine);
    assert_eq!((vehicle.thrust_n, vehicle.battery), (base.thrust_n, base.battery));
    assert!(vehicle.identified.unwrap().assumed.contains_key("battery"));
}

/// Where nobody says what a full stick asks for, it is the base vehicle's, and no less than what was asked for.
#[test]
fn a_full_stick_asks_for_what_was_flown() {
    let mut log = truth::fly(&truth::Vehicle::draw(3), 3, 60.0, 1.0);
    let [roll, _, yaw] = log.vehicle.max_rate_rad_s.take().unwrap().map(f64::to_degrees);
    let mut base = Vehicle::load("seed_class").unwrap();
    (base.max_rate_deg_s.roll, base.max_rate_deg_s.yaw) = (0.2 * roll, 2.0 * yaw);
    let found = identify(vec![check(&log)], &IdentifyOptions::new(base), &mut |_, _| ());
    let [full_roll, _, full_yaw] = found.full_rate_rad_s.map(f64::to_degrees);
    let asked = log.setpoint.column(0).iter().map(|w| w.abs().to_degrees()).fold(0.0, f64::max);
    assert!(full_roll > 0.9 * asked && full_roll <= asked, "{full_roll}, where {asked} was asked for");
    assert!((full_yaw / yaw - 2.0).abs() < 1e-9, "{full_yaw}");
    assert!(found.remarks.iter().any(|r| r.contains("or what the log asks for beyond")), "{:?}", found.remarks);
}

/// Every log where `RACER_FLIGHT_DATA` points to.
#[test]
fn vehicles_of_measured_flights_are_read_back() {
    let Some(folder) = std::env::var_os("RACER_FLIGHT_DATA") else {
        return println!("skipped: RACER_FLIGHT_DATA is not set");
    };
    let mut tried = 0;
    for kind in std::fs::read_dir(folder).unwrap() {
        for file in std::fs::read_dir(kind.unwrap().path()).into_iter().flatten() {
            let path = file.unwrap().path();
            if path.to_string_lossy().contains("_gps") {
                continue;
            }
            let Ok(log) = racer::flight::open(&path, None) else { continue };
            written(&log);
            tried += 1;
        }
    }
    assert!(tried > 0);
}
