//! Studies and diagnoses that are killed at random moments: tables and files are whole or not there, and what is made
//! again is the same. `RACER_KILLS` says how many moments of each are tried.

use super::{killed, moments};
use crate::study::TINY;
use crate::support::racer;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::path::Path;
use std::time::{Duration, Instant};

/// Runs what has to succeed.
fn done(at: &Path, args: &str) -> String {
    let ran = racer(at, &args.split(' ').collect::<Vec<_>>());
    assert_eq!(ran.code, 0, "{args}: {}", ran.err);
    ran.out
}

fn read(folder: &Path, names: &[&str]) -> Vec<Option<Vec<u8>>> {
    names.iter().map(|name| std::fs::read(folder.join(name)).ok()).collect()
}

#[test]
fn a_killed_study_goes_on_to_the_same_tables() {
    const TABLES: [&str; 5] = ["runs.csv", "settings.csv", "axes.csv", "ranking.csv", "results.json"];
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("tiny.toml"), TINY).unwrap();
    let began = Instant::now();
    done(at, "study tiny.toml --out undisturbed");
    let all_s = began.elapsed().as_secs_f64();
    let expected = read(&at.join("undisturbed"), &TABLES);
    assert!(expected.iter().all(Option::is_some));
    let mut rng = StdRng::seed_from_u64(15);
    for moment in 0..moments() {
        let time = rng.random_range(0.0..all_s);
        killed(at, &["study", "tiny.toml", "--out", "study"], Duration::from_secs_f64(time));
        // What there is can be looked at; then it goes on.
        if at.join("study/study.toml").is_file() {
            done(at, "study tiny.toml --out study --table");
        }
        done(at, "study tiny.toml --out study");
        assert_eq!(read(&at.join("study"), &TABLES), expected, "moment {moment} at {time} s");
        std::fs::remove_dir_all(at.join("study")).unwrap();
    }
}

#[test]
fn a_killed_diagnosis_leaves_whole_files_or_none() {
    const FILES: [&str; 3] = ["found.json", "extended.toml", "page.html"];
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    done(at, "fly --pilot --vehicle seed_class --seconds 40 --out flight.mcap");
    let diagnose =
        "diagnose flight.mcap --vehicle seed_class --json found.json --extend extended.toml --report page.html";
    let began = Instant::now();
    done(at, diagnose);
    let all_s = began.elapsed().as_secs_f64();
    let expected = read(at, &FILES);
    let remove = || FILES.iter().for_each(|name| drop(std::fs::remove_file(at.join(name))));
    let mut rng = StdRng::seed_from_u64(16);
    for moment in 0..moments() {
        remove();
        // Files are written in the last moments.
        let time = all_s * rng.random_range(0.0f64..1.0).cbrt();
        killed(at, &diagnose.split(' ').collect::<Vec<_>>(), Duration::from_secs_f64(time));
        let left = read(at, &FILES);
        let whole = left.iter().zip(&expected).all(|(left, expected)| left.is_none() || left == expected);
        assert!(whole, "moment {moment} at {time} s");
    }
    remove();
    done(at, diagnose);
    assert_eq!(read(at, &FILES), expected);
}
