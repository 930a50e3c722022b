//! Trainings that are killed at random moments: what is on disk is whole, and they go on to the same policies.
//!
//! `RACER_KILLS` says how many moments are tried, `RACER_KILLS_TABLE` where a table of them is written as it comes.

mod others;

use crate::support::racer;
use assert_cmd::cargo::CommandCargoExt;
use racer::race::snapshot::Snapshot;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A training of some 60 updates.
pub const TINY: &str = "--track square --steps 60000 --threads 1 --set ppo.environments=64 --set ppo.rollout=16 --set \
    ppo.minibatches=2 --set ppo.epochs=2 --set eval.agents=8 --set eval.max_steps=60 --set budget.snapshots=6";

fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

/// Trains into the new folder `out` of `at`.
pub fn train(at: &Path, out: &str) {
    let ran = racer(at, &[&["train", "--out", out][..], &words(TINY)].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
}

/// Policy and snapshots.
pub fn policies(run: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = files(&run.join("snapshots"), "safetensors");
    files.push(run.join("policy.safetensors"));
    files.iter().map(|path| (path.strip_prefix(run).unwrap().into(), std::fs::read(path).unwrap())).collect()
}

fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let there = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut all: Vec<_> = there.filter(|path| path.to_string_lossy().ends_with(ending)).collect();
    all.sort();
    all
}

/// Makes sure that what a killed training left is whole; how much there is.
fn whole(run: &Path) -> (usize, usize, usize) {
    let snapshots = files(&run.join("snapshots"), ".safetensors");
    for path in &snapshots {
        Snapshot::read(path).unwrap();
    }
    let log = std::fs::read_to_string(run.join("metrics.csv")).unwrap_or_default();
    let cells = |line: &str| line.split(',').count();
    // A kill may come between two pages of one write: of the last row a part may be there, which no reader takes.
    let rows = &log[..log.rfind('\n').map_or(0, |end| end + 1)];
    let header = rows.lines().next().map_or(0, cells);
    assert!(rows.lines().all(|line| cells(line) == header), "half a row before the end");
    for path in files(&run.join("tensorboard"), ".racer") {
        let bytes = std::fs::read(path).unwrap();
        let mut rest = &bytes[..];
        // Length, its checksum, data, its checksum; of the last event a part may be there.
        while let Some(length) = rest.first_chunk().map(|bytes| u64::from_le_bytes(*bytes) as usize) {
            assert!(length < 1 << 16, "no event where one should begin");
            rest = rest.get(16 + length..).unwrap_or_default();
        }
    }
    (rows.lines().count().saturating_sub(1), snapshots.len(), files(&run.join("checkpoints"), ".checkpoint").len())
}

/// How many moments are tried.
pub fn moments() -> usize {
    std::env::var("RACER_KILLS").map_or(4, |n| n.parse().unwrap())
}

/// Starts `racer args` and kills it after `time`; whether it had ended before.
pub fn killed(at: &Path, args: &[&str], time: Duration) -> bool {
    let mut command = Command::cargo_bin("racer").unwrap();
    let command = command.current_dir(at).args(args).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().unwrap();
    std::thread::sleep(time);
    let ended = child.try_wait().unwrap().is_some();
    child.kill().unwrap();
    child.wait().unwrap();
    ended
}

#[test]
fn what_a_killed_training_leaves_is_whole_and_goes_on_to_the_same_policies() {
    let moments = moments();
    let mut table = std::env::var("RACER_KILLS_TABLE").ok().map(|path| std::fs::File::create(path).unwrap());
    if let Some(table) = &mut table {
        writeln!(table, "moment,killed_after_s,kills,rows,snapshots,checkpoints,went_on,policies").unwrap();
    }
    let at = tempfile::tempdir().unwrap();
    let began = Instant::now();
    train(at.path(), "undisturbed");
    let all_s = began.elapsed().as_secs_f64();
    let expected = policies(&at.path().join("undisturbed"));
    let mut rng = StdRng::seed_from_u64(14);
    for moment in 0..moments {
        let name = format!("run{moment}");
        let run = at.path().join(&name);
        let mut args = [&["train", "--out", &name][..], &words(TINY)].concat();
        let (mut kills, mut first_s, mut found) = (0, 0.0, (0, 0, 0));
        let mut went_on = "ended before";
        // One kill, or now and then two or three.
        while kills == 0 || (kills < 3 && rng.random_bool(0.25)) {
            let time = rng.random_range(0.0..all_s);
            if killed(at.path(), &args, Duration::from_secs_f64(time)) {
                break;
            }
            (first_s, kills) = (if kills == 0 { time } else { first_s }, kills + 1);
            found = whole(&run);
            (args, went_on) = if run.join("checkpoints").is_dir() {
                (vec!["train", "--resume", &name], if found.2 > 0 { "from a checkpoint" } else { "from the start" })
            } else if run.join("policy.safetensors").is_file() {
                // Killed between its last file and its end.
                (vec!["train", "--resume", &name], "was finished")
            } else {
                // Not even the configuration was whole: it says so, and is begun anew.
                let ran = racer(at.path(), &["train", "--resume", &name]);
                assert!(ran.code == 2 || ran.code == 0, "{}", ran.err);
                let _ = std::fs::remove_dir_all(&run);
                ([&["train", "--out", &name][..], &words(TINY)].concat(), "anew")
            };
        }
        if kills > 0 {
            let ran = racer(at.path(), &args);
            assert_eq!(ran.code, 0, "moment {moment} at {first_s} s: {}", ran.err);
        }
        let same = policies(&run) == expected;
        if let Some(table) = &mut table {
            let (rows, snapshots, checkpoints) = found;
            let same = if same { "the same" } else { "OTHERS" };
            let counts = format!("{kills},{rows},{snapshots},{checkpoints}");
            writeln!(table, "{moment},{first_s:.3},{counts},{went_on},{same}").unwrap();
        }
        assert!(same, "moment {moment} at {first_s} s");
        let leftovers = [run.clone(), run.join("snapshots")].map(|folder| {
            std::fs::read_dir(folder)
                .unwrap()
                .flatten()
                .filter(|e| e.file_name().to_string_lossy().starts_with('.'))
                .count()
        });
        assert_eq!((leftovers, run.join("checkpoints").exists()), ([0, 0], false));
        std::fs::remove_dir_all(run).unwrap();
    }
}
