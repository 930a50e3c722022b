//! The built-in mappings against the flights that they are for: units, signs and frames.

use crate::support::flight_data;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use racer::flight::{self, Log, Readable, Stream};

/// The logs of a folder of flight data; none, with a word about it, where they are absent.
fn logs(folder: &str, files: &[&str]) -> Vec<Log> {
    let Some(folder) = flight_data(folder) else { return Vec::new() };
    files.iter().map(|file| flight::open(&folder.join(format!("{file}.csv.gz")), None).unwrap()).collect()
}

/// Pearson's correlation, and the slope of b over a.
fn alike(pairs: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let pairs: Vec<_> = pairs.filter(|(a, b)| a.is_finite() && b.is_finite()).collect();
    let n = pairs.len() as f64;
    let (mean_a, mean_b) = (pairs.iter().map(|p| p.0).sum::<f64>() / n, pairs.iter().map(|p| p.1).sum::<f64>() / n);
    let sum = |f: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|(a, b)| f(a - mean_a, b - mean_b)).sum::<f64>();
    let (aa, ab, bb) = (sum(&|a, _| a * a), sum(&|a, b| a * b), sum(&|_, b| b * b));
    (ab / (aa * bb).sqrt(), ab / aa)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The correlation of gyro and setpoint that is strongest, of either sign, among all delays to a quarter of a second.
fn gyro_follows_setpoint(log: &Log, until_s: f64) -> [f64; 3] {
    let rows = log.imu.time_s.iter().take_while(|&&time| time < until_s).count();
    let step = log.imu.time_s[rows - 1] / rows as f64;
    [0, 1, 2].map(|axis| {
        let at = |lag: usize| alike((lag..rows).map(|i| (log.setpoint.rows[i - lag][axis], log.imu.rows[i][axis]))).0;
        (0..(0.25 / step) as usize).map(at).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap()
    })
}

/// Median specific force upwards while it hardly turns, m/s2.
fn lift(log: &Log) -> f64 {
    let calm = log.imu.rows.iter().filter(|row| row[..3].iter().all(|rate| rate.abs() < 0.2));
    median(calm.map(|row| row[5]).collect())
}

fn attitude(row: &[f64; 10]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(row[3], row[4], row[5], row[6]))
}

/// How the attitude turns along each axis, compared with the gyro: correlation and slope. Both streams share their
/// rows.
fn attitude_turns_as_gyro(log: &Log, step: usize) -> [(f64, f64); 3] {
    let Stream { time_s, rows } = &log.odometry;
    let at = |i: usize| {
        let turn = (attitude(&rows[i]).inverse() * attitude(&rows[i + step])).scaled_axis();
        let gyro = |axis: usize| log.imu.rows[i..i + step].iter().map(|row| row[axis]).sum::<f64>() / step as f64;
        (turn / (time_s[i + step] - time_s[i]), [0, 1, 2].map(gyro))
    };
    let pairs: Vec<_> = (0..rows.len() - step).map(at).collect();
    [0, 1, 2].map(|axis| alike(pairs.iter().map(|(rate, gyro)| (gyro[axis], rate[axis]))))
}

/// Median distance, along each axis of the world, between the velocity and the slope of the position, m/s.
fn velocity_off(log: &Log, step: usize) -> [f64; 3] {
    let Stream { time_s, rows } = &log.odometry;
    [0, 1, 2].map(|axis| {
        let at = |i: usize| {
            let slope = (rows[i + step][axis] - rows[i][axis]) / (time_s[i + step] - time_s[i]);
            let row = &rows[i + step / 2];
            (slope - (attitude(row) * Vector3::new(row[7], row[8], row[9]))[axis]).abs()
        };
        median((0..rows.len() - step).map(at).collect())
    })
}

/// Whether odometry, gyro and accelerometer belong together.
fn consistent(log: &Log, steps: [usize; 2], least: f64, most_off_m_s: f64) {
    let turns = attitude_turns_as_gyro(log, steps[0]);
    let off = velocity_off(log, steps[1]);
    println!("{}: attitude {turns:.3?}, velocity off by {off:.3?}, lift {:.2}", log.name, lift(log));
    assert!(turns.iter().all(|(alike, slope)| *alike > least && (slope - 1.0).abs() < 0.2), "{}: {turns:?}", log.name);
    assert!(off.iter().all(|off| *off < most_off_m_s), "{}: {off:?}", log.name);
    assert!((lift(log) - 9.81).abs() < 0.3, "{}: {}", log.name, lift(log));
    assert_eq!(log.readable, Readable::Whole);
}

#[test]
fn betaflight_csv() {
    let files = ["roma_f5_log1", "roma_f5_log2", "roma_f5_log3", "ar8_LOG00037", "gecko_btfl_002_log1"];
    // Two end in a crash, after which nothing follows anything.
    for (log, until_s) in logs("betaflight", &files).iter().zip([60.0, 80.0, 1e9, 15.0, 1e9]) {
        let follows = gyro_follows_setpoint(log, until_s);
        println!("{}: follows {follows:.3?}, lift {:.2}", log.name, lift(log));
        assert!(follows.iter().all(|alike| *alike > 0.9), "{}: {follows:?}", log.name);
        assert!((lift(log) - 9.81).abs() < 1.0, "{}: {}", log.name, lift(log));
        assert!(log.setpoint.column(3).iter().all(|thrust| (0.0..=1.0).contains(thrust)));
        assert!(log.battery.rows.iter().all(|row| (12.0..26.0).contains(&row[0])));
        let gps = log.name.contains("roma");
        assert_eq!(log.odometry.is_empty(), !gps, "{}", log.name);
        assert!(log.odometry.rows.iter().all(|row| row[2].abs() < 80.0 && row[7].is_nan()), "{}", log.name);
        let measured = log.battery.rows.iter().all(|row| row[1].is_finite());
        assert_eq!(measured, !log.name.contains("gecko"), "{}: a current sensor", log.name);
    }
}

#[test]
fn indiflight() {
    let files = ["indiflight_LOG00230", "indiflight_LOG00267", "indiflight_LOG00269", "indiflight_LOG00281"];
    for (i, log) in logs("indiflight", &files).iter().enumerate() {
        consistent(log, [20, 50], 0.98, 0.1);
        assert!(log.battery.is_empty());
        assert!(log.rotors.rows.iter().flat_map(|row| &row[..4]).all(|speed| (0.0..8000.0).contains(speed)));
        // The first does not fly after its throw long enough to follow anything.
        if i > 0 {
            let follows = gyro_follows_setpoint(log, 1e9);
            assert!(follows.iter().all(|alike| *alike > 0.4), "{}: {follows:?}", log.name);
        }
    }
}

#[test]
fn neurobem() {
    let files = [
        "neurobem_20210218170320seg2",
        "neurobem_20210218171908seg2",
        "neurobem_20210218172600seg1",
        "neurobem_20210223104803seg2",
    ];
    for log in &logs("neurobem", &files) {
        consistent(log, [20, 50], 0.6, 0.02);
        assert_eq!(log.vehicle.mass_kg, Some(0.772));
        assert!(log.setpoint.rows.iter().all(|row| row[0].is_nan() && (0.0..1.0).contains(&row[3])));
    }
}

#[test]
fn nanobench() {
    for log in &logs("nanobench", &["B2_circle_fast_rep1", "B5_helix_fast_rep1", "B7_oval_fast_rep3"]) {
        consistent(log, [6, 10], 0.6, 0.005);
        assert!(log.start_ns > 1_700_000_000_000_000_000, "seconds since 1970");
        assert!(log.setpoint.rows.iter().all(|row| (0.0..=1.0).contains(&row[3])));
    }
}
