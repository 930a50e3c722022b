//! The built-in mappings against the flights that they are for: units, signs and frames.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use racer::flight::{self, Log, Stream};
use std::path::PathBuf;

/// The logs of a folder of flight data; none, with a word about it, where they are absent.
fn logs(folder: &str, files: &[&str]) -> Vec<Log> {
    let root = std::env::var_os("RACER_FLIGHT_DATA").map_or("../shared/flight-data".into(), PathBuf::from);
    let folder = root.join(folder);
    if !folder.is_dir() {
        println!("skipped: no {} (RACER_FLIGHT_DATA says where flight data is)", folder.display());
        return Vec::new();
    }
    files.iter().map(|file| flight::open(&folder.join(file), None).unwrap()).collect()
}

fn correlation(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut n, mut sa, mut sb, mut saa, mut sbb, mut sab) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (a, b) in pairs.filter(|(a, b)| a.is_finite() && b.is_finite()) {
        n += 1.0;
        sa += a;
        sb += b;
        saa += a * a;
        sbb += b * b;
        sab += a * b;
    }
    (n * sab - sa * sb) / ((n * saa - sa * sa) * (n * sbb - sb * sb)).sqrt()
}

/// Whether, of all delays to a quarter of a second, the gyro looks most like the setpoint where it looks like plus it.
fn follows_setpoint(log: &Log, axis: usize, until_s: f64) -> f64 {
    let rows = log.imu.time_s.iter().take_while(|&&time| time < until_s).count();
    let step = log.imu.time_s[rows - 1] / rows as f64;
    let at = |lag: usize| correlation((lag..rows).map(|i| (log.setpoint.rows[i - lag][axis], log.imu.rows[i][axis])));
    (0..(0.25 / step) as usize).map(at).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap()
}

/// Median specific force along z where it hardly turns.
fn gravity(log: &Log) -> f64 {
    let calm = log.imu.rows.iter().filter(|row| row[..3].iter().all(|rate| rate.abs() < 0.2));
    let mut z: Vec<f64> = calm.map(|row| row[5]).collect();
    z.sort_by(f64::total_cmp);
    z[z.len() / 2]
}

fn attitude(row: &[f64; 10]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(row[3], row[4], row[5], row[6]))
}

/// Correlation, per axis, of the gyro with the rates at which the attitude turns. Both streams share their rows.
fn attitude_turns_as_gyro(log: &Log, step: usize) -> [f64; 3] {
    let Stream { time_s, rows } = &log.odometry;
    let at = |i: usize| {
        let turn = (attitude(&rows[i]).inverse() * attitude(&rows[i + step])).scaled_axis();
        (turn / (time_s[i + step] - time_s[i]), &log.imu.rows[i + step / 2])
    };
    std::array::from_fn(|axis| correlation((0..rows.len() - step).map(at).map(|(rate, gyro)| (rate[axis], gyro[axis]))))
}

/// Median distance, per axis of the world, between the velocity and the slope of the position, m/s.
fn velocity_off(log: &Log, step: usize) -> [f64; 3] {
    let Stream { time_s, rows } = &log.odometry;
    std::array::from_fn(|axis| {
        let mut off: Vec<f64> = (0..rows.len() - step)
            .map(|i| {
                let slope = (rows[i + step][axis] - rows[i][axis]) / (time_s[i + step] - time_s[i]);
                let row = &rows[i + step / 2];
                (slope - (attitude(row) * Vector3::new(row[7], row[8], row[9]))[axis]).abs()
            })
            .collect();
        off.sort_by(f64::total_cmp);
        off[off.len() / 2]
    })
}

/// Median of |force - expected|, with the force from velocity's slope and gravity.
fn report(log: &Log) {
    println!("{} start {} ns", log.name, log.start_ns);
    for (name, n, end) in [
        ("setpoint", log.setpoint.len(), log.setpoint.time_s.last()),
        ("imu", log.imu.len(), log.imu.time_s.last()),
        ("odometry", log.odometry.len(), log.odometry.time_s.last()),
        ("battery", log.battery.len(), log.battery.time_s.last()),
        ("rotors", log.rotors.len(), log.rotors.time_s.last()),
    ] {
        println!("  {name} {n} {end:?}");
    }
}

#[test]
fn betaflight_csv() {
    for (log, until) in logs(
        "betaflight",
        &[
            "roma_f5_log1.csv.gz",
            "roma_f5_log2.csv.gz",
            "roma_f5_log3.csv.gz",
            "ar8_LOG00037.csv.gz",
            "gecko_btfl_002_log1.csv.gz",
        ],
    )
    .iter()
    .zip([60.0, 80.0, 125.0, 15.0, 130.0])
    {
        report(log);
        println!("  follows {:?} g {}", [0, 1, 2].map(|axis| follows_setpoint(log, axis, until)), gravity(log));
    }
}

#[test]
fn indiflight() {
    for log in &logs(
        "indiflight",
        &[
            "indiflight_LOG00230.csv.gz",
            "indiflight_LOG00267.csv.gz",
            "indiflight_LOG00269.csv.gz",
            "indiflight_LOG00281.csv.gz",
        ],
    ) {
        report(log);
        println!("  follows {:?} g {}", [0, 1, 2].map(|axis| follows_setpoint(log, axis, 1e9)), gravity(log));
        println!("  att {:?} vel {:?}", attitude_turns_as_gyro(log, 20), velocity_off(log, 50));
    }
}

#[test]
fn neurobem() {
    for log in &logs(
        "neurobem",
        &[
            "neurobem_20210218170320seg2.csv.gz",
            "neurobem_20210218171908seg2.csv.gz",
            "neurobem_20210218172600seg1.csv.gz",
            "neurobem_20210223104803seg2.csv.gz",
        ],
    ) {
        report(log);
        println!("  att {:?} vel {:?} g {}", attitude_turns_as_gyro(log, 20), velocity_off(log, 50), gravity(log));
    }
}

#[test]
fn nanobench() {
    for log in
        &logs("nanobench", &["B2_circle_fast_rep1.csv.gz", "B5_helix_fast_rep1.csv.gz", "B7_oval_fast_rep3.csv.gz"])
    {
        report(log);
        println!("  att {:?} vel {:?} g {}", attitude_turns_as_gyro(log, 6), velocity_off(log, 10), gravity(log));
    }
}
