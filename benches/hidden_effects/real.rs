//! Effects put into measured flights, which have causes of their own: what they are called untouched does not count.

use crate::answer::Answer;
use crate::args::Args;
use crate::case::Group;
use crate::judge::Judged;
use crate::rows::Row;
use crate::run::{self, Folder};
use crate::truth::Vehicle;
use crate::truth::effects::Hidden;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use racer::flight::{self, Log};
use rand::SeedableRng;
use rand::rngs::StdRng;
use std::path::PathBuf;

/// Files, and what of theirs can be changed: who lacks setpoints cannot be late, who lacks velocity cannot lag.
const FLIGHTS: [(&str, &[(&str, f64)]); 4] = [
    ("neurobem/neurobem_20210218171908seg2.csv.gz", KINEMATIC),
    ("neurobem/neurobem_20210218172600seg1.csv.gz", KINEMATIC),
    ("betaflight/gecko_btfl_002_log1.csv.gz", &[("rate_delay", 0.02), ("rate_delay", 0.008)]),
    ("indiflight/indiflight_LOG00281.csv.gz", KINEMATIC),
];
const KINEMATIC: &[(&str, f64)] =
    &[("stream_offset", 0.008), ("imu_lever_arm", 0.03), ("gyro_scale", 0.03), ("velocity_lag", 0.06)];
/// Half the time that a body rate's change is taken over, s.
const SLOPE_S: f64 = 0.008;

/// All flights that are there, with each of their effects.
pub fn all(args: &Args) -> Vec<Judged> {
    let root = std::env::var_os("RACER_FLIGHT_DATA").map_or("../shared/flight-data".into(), PathBuf::from);
    let mut judged = Vec::new();
    for (file, effects) in FLIGHTS {
        let path = root.join(file);
        if !path.is_file() {
            println!("skipped: no {file} where RACER_FLIGHT_DATA says that flight data is");
            continue;
        }
        match flight::open(&path, None) {
            Ok(log) => judged.extend(one(args, file, &log, effects)),
            Err(error) => println!("skipped: {error}"),
        }
    }
    judged
}

fn one(args: &Args, file: &str, log: &Log, effects: &[(&str, f64)]) -> Vec<Judged> {
    let folder = Folder::new(args, &file.replace(['/', '.'], "_"));
    run::write(&folder.path, log);
    let _ = std::fs::remove_file(folder.path.join("measured.toml"));
    let identify = ["identify", "log.mcap", "--out", "measured.toml", "--despite-problems"];
    if let Err(error) = run::run(args, &folder.path, &identify) {
        println!("skipped: {file} identifies no vehicle: {error}");
        return Vec::new();
    }
    let base = racer::model::vehicle::Vehicle::load(&folder.path.join("measured.toml").display().to_string());
    let base = base.expect("what identification wrote");
    let (untouched, seconds) = run::diagnose(args, &folder.path, log, &base);
    let names = |answer: &Answer| answer.named().map(|finding| finding.effect.clone()).collect();
    let before: Vec<String> = untouched.as_ref().map_or(Vec::new(), names);
    match &untouched {
        Ok(answer) => println!("{file}, untouched: {} [{}]  {seconds:.1} s", before.join(", "), answer.verdict),
        Err(error) => println!("{file}, untouched: FAILED: {error}"),
    }
    let mut rng = StdRng::seed_from_u64(args.seed);
    // What an untouched log is said to have cannot be told from what is put in.
    let put = effects.iter().filter(|(id, _)| !before.iter().any(|name| name == id)).map(|(id, size)| {
        let hidden = Hidden::sized(id, *size, &Vehicle::seed_class(), &mut rng);
        let (answer, seconds) = run::diagnose(args, &folder.path, &with(log, &hidden), &base);
        let judged = Judged {
            group: Group::Real,
            hidden: vec![hidden],
            before: before.clone(),
            answer,
            seconds,
            extended: None,
        };
        println!("{file}  {}", judged.line());
        judged
    });
    put.collect()
}

/// The log as it would be with `hidden`.
fn with(log: &Log, hidden: &Hidden) -> Log {
    let mut log = log.clone();
    match hidden.id.as_str() {
        "rate_delay" => delay_answers(&mut log, hidden.get("delay")),
        "stream_offset" => offset_gyro(&mut log, hidden.get("offset")),
        "gyro_scale" => {
            let factor = 1.0 + hidden.get("scale");
            log.imu.rows.iter_mut().for_each(|row| row[..3].iter_mut().for_each(|w| *w *= factor));
        }
        "imu_lever_arm" => move_imu(&mut log, Vector3::from(["rx", "ry", "rz"].map(|name| hidden.get(name)))),
        "velocity_lag" => lag_velocity(&mut log, hidden.get("tau")),
        unknown => panic!("{unknown} cannot be put into a log"),
    }
    log
}

/// What is answered at t was sent `delay` earlier: the sent one of t + `delay` is written at t.
fn delay_answers(log: &mut Log, delay: f64) {
    let before = log.setpoint.clone();
    for (time, row) in log.setpoint.time_s.iter().zip(&mut log.setpoint.rows) {
        let then = before.time_s.partition_point(|t| *t <= time + delay).saturating_sub(1);
        row[..3].copy_from_slice(&before.rows[then][..3]);
    }
}

fn offset_gyro(log: &mut Log, offset: f64) {
    let before = log.imu.clone();
    for (time, row) in before.time_s.iter().zip(&mut log.imu.rows) {
        let next = before.time_s.partition_point(|t| *t <= time - offset).clamp(1, before.len() - 1);
        let [from, to] = [before.time_s[next - 1], before.time_s[next]];
        let share = ((time - offset - from) / (to - from)).clamp(0.0, 1.0);
        for (k, rate) in row[..3].iter_mut().enumerate() {
            *rate = before.rows[next - 1][k] * (1.0 - share) + before.rows[next][k] * share;
        }
    }
}

fn move_imu(log: &mut Log, lever: Vector3<f64>) {
    let before = log.imu.clone();
    let rates = |k: usize| Vector3::from_column_slice(&before.rows[k][..3]);
    for (k, row) in log.imu.rows.iter_mut().enumerate() {
        let time = before.time_s[k];
        let first = before.time_s.partition_point(|t| *t < time - SLOPE_S);
        let last = before.time_s.partition_point(|t| *t <= time + SLOPE_S) - 1;
        let faster = if last > first {
            (rates(last) - rates(first)) / (before.time_s[last] - before.time_s[first])
        } else {
            Vector3::zeros()
        };
        let w = rates(k);
        let felt = faster.cross(&lever) + w.cross(&w.cross(&lever));
        (0..3).for_each(|i| row[3 + i] += felt[i]);
    }
}

/// A low-pass of the velocity in the world.
fn lag_velocity(log: &mut Log, tau: f64) {
    let mut estimate: Option<Vector3<f64>> = None;
    let mut before = 0.0;
    for (time, row) in log.odometry.time_s.iter().zip(&mut log.odometry.rows) {
        if !row[3..].iter().all(|x| x.is_finite()) {
            continue;
        }
        let attitude = UnitQuaternion::new_normalize(Quaternion::new(row[3], row[4], row[5], row[6]));
        let velocity = attitude * Vector3::new(row[7], row[8], row[9]);
        let gain = 1.0 - (-(time - before) / tau).exp();
        let lagging = estimate.map_or(velocity, |last| last + (velocity - last) * gain);
        let body = attitude.inverse() * lagging;
        row[7..].copy_from_slice(body.as_slice());
        (estimate, before) = (Some(lagging), *time);
    }
}
