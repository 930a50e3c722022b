//! What goes wrong around a training, and what is said and left then.

use crate::kills::{TINY, policies, train};
use crate::support::racer;
use assert_cmd::cargo::CommandCargoExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

fn start(at: &Path, args: &[&str]) -> Child {
    let mut command = Command::cargo_bin("racer").unwrap();
    command.current_dir(at).args(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

#[cfg(unix)]
fn hidden(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).unwrap().flatten();
    entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(".racer-")).count()
}

#[test]
fn the_same_training_is_the_same_file() {
    let at = tempfile::tempdir().unwrap();
    ["a", "b"].iter().for_each(|out| train(at.path(), out));
    assert!(policies(&at.path().join("a")) == policies(&at.path().join("b")));
}

/// The folder of the policies goes away in the middle of a training, and comes back.
#[test]
fn a_training_that_cannot_write_says_what_is_safe_and_goes_on_later() {
    let at = tempfile::tempdir().unwrap();
    train(at.path(), "whole");
    let args = TINY.split_whitespace();
    let child = start(at.path(), &["train", "--out", "run"].into_iter().chain(args).collect::<Vec<_>>());
    let (run, aside) = (at.path().join("run"), at.path().join("aside"));
    while std::fs::read_dir(run.join("snapshots")).map_or(0, |all| all.count()) < 2 {
        std::thread::sleep(Duration::from_millis(2));
    }
    std::fs::rename(run.join("snapshots"), &aside).unwrap();
    let output = child.wait_with_output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("could not be written") && told.contains("is safe"), "{told}");
    assert!(told.contains("racer train --resume run") && !run.join("policy.safetensors").exists(), "{told}");
    std::fs::rename(aside, run.join("snapshots")).unwrap();
    assert_eq!(racer(at.path(), &["train", "--resume", "run"]).code, 0);
    assert!(policies(&run) == policies(&at.path().join("whole")));
}

/// As on a full disk: no file may grow beyond 10 kB.
#[cfg(unix)]
#[test]
fn a_file_that_may_not_grow_is_told_and_the_training_goes_on_later() {
    let at = tempfile::tempdir().unwrap();
    let limited = format!("ulimit -f 20; exec {} train --out run {TINY}", env!("CARGO_BIN_EXE_racer"));
    let output = Command::new("sh").args(["-c", &limited]).current_dir(at.path()).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("could not be written") && told.contains("racer train --resume run"), "{told}");
    assert_eq!(hidden(at.path()), 0);
    assert_eq!(racer(at.path(), &["train", "--resume", "run"]).code, 0);
    train(at.path(), "whole");
    assert!(policies(&at.path().join("run")) == policies(&at.path().join("whole")));
}

#[test]
fn what_does_not_fit_into_memory_is_refused_before_there_is_a_folder() {
    let at = tempfile::tempdir().unwrap();
    let large = "train --set ppo.environments=16777216 --set ppo.rollout=16 --set ppo.minibatches=1024 --out run";
    let ran = racer(at.path(), &large.split(' ').collect::<Vec<_>>());
    assert!(ran.code == 2 && ran.err.contains("of memory") && ran.err.contains("lower one"), "{}", ran.err);
    assert!(!at.path().join("run").exists());
}

#[test]
fn a_run_that_is_being_trained_is_not_trained_by_another() {
    let at = tempfile::tempdir().unwrap();
    let long = TINY.replace("60000", "60000000");
    let args = long.split_whitespace();
    let mut child = start(at.path(), &["train", "--out", "run"].into_iter().chain(args).collect::<Vec<_>>());
    let run = at.path().join("run");
    while !run.join("metrics.csv").is_file() {
        std::thread::sleep(Duration::from_millis(2));
    }
    let ran = racer(at.path(), &["train", "--resume", "run"]);
    assert!(ran.code == 2 && ran.err.contains("another process"), "{}", ran.err);
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn evaluations_side_by_side_get_a_file_each() {
    let at = tempfile::tempdir().unwrap();
    train(at.path(), "run");
    let all: Vec<Child> = (0..4).map(|_| start(at.path(), &["eval", "run", "--agents", "64"])).collect();
    for child in all {
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let entries = std::fs::read_dir(at.path().join("run")).unwrap().flatten();
    let names: Vec<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    assert_eq!(names.iter().filter(|name| name.starts_with("evaluation-both-64")).count(), 4, "{names:?}");
}

/// Every signal that asks a process to end takes its temporary files along.
#[cfg(unix)]
#[test]
fn signals_leave_no_temporary_file() {
    let at = tempfile::tempdir().unwrap();
    train(at.path(), "run");
    for signal in ["INT", "TERM", "HUP"] {
        let mut child = start(at.path(), &["eval", "run", "--agents", "200000", "--threads", "1"]);
        while hidden(&at.path().join("run")) == 0 {
            assert!(child.try_wait().unwrap().is_none(), "it ended before it was asked to");
            std::thread::sleep(Duration::from_millis(2));
        }
        let asked = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
        assert!(asked.success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "{signal}");
        assert_eq!(hidden(&at.path().join("run")), 0, "{signal}");
    }
}

#[test]
fn a_study_makes_damaged_runs_again_and_does_not_rank_what_diverged() {
    let at = tempfile::tempdir().unwrap();
    let study = "steps = 4000\nseeds = 2\nagents = 8\n[set]\ntrack = 'square'\nppo.environments = 64\n\
                 ppo.minibatches = 2\nppo.rollout = 16\neval.max_steps = 60\nbudget.snapshots = 2\n\
                 [grid]\nppo.value_coefficient = [0.5, 1e38]\n";
    std::fs::write(at.path().join("tiny.toml"), study).unwrap();
    let make = || racer(at.path(), &["study", "tiny.toml", "--out", "s", "--threads", "1"]);
    let ran = make();
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.out.contains("diverged, and neither ranked"), "{}", ran.out);
    let table = std::fs::read_to_string(at.path().join("s/ranking.csv")).unwrap();
    assert_eq!(table.lines().count(), 2, "{table}");
    let runs = at.path().join("s/runs");
    let mut names: Vec<_> = std::fs::read_dir(&runs).unwrap().map(|e| e.unwrap().path()).collect();
    names.sort();
    assert_eq!(names.len(), 4);
    let good: Vec<_> = names.iter().filter(|run| run.join("result.json").is_file()).collect();
    assert_eq!(good.len(), 2);
    let tables = || ["runs.csv", "results.json"].map(|name| std::fs::read(at.path().join("s").join(name)).unwrap());
    let before = tables();
    for (damaged, content) in [
        ("result.json", None),
        ("result.json", Some("{\"run\"")),
        ("config.toml", Some("")),
        ("policy.safetensors", Some("")),
    ] {
        let path = good[0].join(damaged);
        match content {
            None => std::fs::remove_file(&path).unwrap(),
            Some(content) => std::fs::write(&path, content).unwrap(),
        }
        let ran = make();
        assert_eq!(ran.code, 0, "{damaged}: {}", ran.err);
        assert!(
            ran.err.contains("was damaged") && ran.err.contains(&Path::new("s").join("damaged").display().to_string()),
            "{damaged}: {}",
            ran.err
        );
        assert!(tables() == before, "{damaged}");
    }
    assert_eq!(std::fs::read_dir(at.path().join("s/damaged")).unwrap().count(), 4);
    let idle = make();
    assert!(idle.code == 0 && !idle.err.contains("damaged"), "{}", idle.err);
}
