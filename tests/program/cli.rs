//! The commands as a user meets them: exit codes, what is printed where, what is left on disk.

use crate::support::racer;
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// A training of a second.
const TINY: [&str; 18] = [
    "train",
    "--track=square",
    "--steps=8000",
    "--set=ppo.environments=64",
    "--set=ppo.rollout=16",
    "--set=ppo.minibatches=2",
    "--set",
    "ppo.epochs=2",
    "--set",
    "eval.agents=20",
    "--set",
    "eval.max_steps=150",
    "--set",
    "budget.snapshots=3",
    "--seed",
    "5",
    "--out",
    "run",
];

fn trained() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let ran = racer(folder.path(), &TINY);
    assert_eq!(ran.code, 0, "{}", ran.err);
    folder
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The keys that the results of one start distribution have.
const KEYS: [&str; 9] = [
    "agents",
    "lap_completion",
    "lap_time_s",
    "gates_passed",
    "top_speed_m_s",
    "saturated_share",
    "mean_action_change_sq",
    "failures_by_gate",
    "sections",
];

#[test]
fn a_run_leaves_everything_behind() {
    let folder = trained();
    let run = folder.path().join("run");
    for file in ["command.txt", "config.toml", "track.toml", "vehicle.toml", "provenance.json", "metrics.csv"] {
        assert!(run.join(file).is_file(), "{file}");
    }
    let count = |name: &str| std::fs::read_dir(run.join(name)).unwrap().count();
    assert_eq!((count("snapshots"), count("tensorboard")), (3, 1));
    let command = std::fs::read_to_string(run.join("command.txt")).unwrap();
    assert!(command.contains("--set=ppo.environments=64 ") && command.ends_with("--out run\n"), "{command}");
    // 8000 steps are eight rollouts of 1024.
    let metrics = std::fs::read_to_string(run.join("metrics.csv")).unwrap();
    assert_eq!(metrics.lines().count(), 9);
    assert!(metrics.starts_with("steps,time/seconds,") && metrics.lines().last().unwrap().starts_with("8192,"));
    let evaluation = json(&run.join("evaluation.json"));
    for start in ["fixed", "random"] {
        assert!(KEYS.iter().all(|key| evaluation[start].get(key).is_some()), "{evaluation}");
        assert_eq!(evaluation[start]["agents"], 20);
    }
    assert_eq!(json(&run.join("snapshots.json")).as_array().unwrap().len(), 3);
    assert_eq!(json(&run.join("provenance.json"))["racer"], env!("CARGO_PKG_VERSION"));
}

#[test]
fn a_run_repeats_bit_for_bit_on_any_number_of_threads() {
    let (first, second) = (trained(), tempfile::tempdir().unwrap());
    let config = first.path().join("run/config.toml");
    let args = ["train", "--config", config.to_str().unwrap(), "--threads", "1", "--out", "run"];
    assert_eq!(racer(second.path(), &args).code, 0);
    let snapshots = |folder: &Path| {
        let entries = std::fs::read_dir(folder.join("run/snapshots")).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(snapshots(first.path()), snapshots(second.path()));
    for name in snapshots(first.path()) {
        let weights = |folder: &Path| {
            let bytes = std::fs::read(folder.join("run/snapshots").join(&name)).unwrap();
            // The header tells the training time, which differs.
            let header = u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
            bytes[8 + header..].to_vec()
        };
        assert!(weights(first.path()) == weights(second.path()), "{name:?}");
    }
}

#[test]
fn eval_prints_writes_and_judges() {
    let folder = trained();
    let ran = racer(folder.path(), &["eval", "run", "--start", "fixed", "--agents", "17", "--json"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let printed: Value = serde_json::from_str(&ran.out).unwrap();
    assert_eq!(printed["fixed"]["agents"], 17);
    assert!(printed.get("random").is_none());
    assert_eq!(json(&folder.path().join("run/evaluation-fixed-17.json")), printed);

    let again = racer(folder.path(), &["eval", "run/policy.safetensors", "--out", "e.json", "--threads", "1"]);
    assert_eq!(again.code, 0, "{}", again.err);
    assert!(again.out.contains("lap completion") && again.out.contains("random start"), "{}", again.out);
    // The training's own evaluation said the same.
    assert_eq!(json(&folder.path().join("e.json"))["fixed"], json(&folder.path().join("run/evaluation.json"))["fixed"]);

    let other = racer(folder.path(), &["eval", "run", "--vehicle", "a2rl_class", "--agents", "3"]);
    assert!(other.code == 0 && other.out.contains("in a2rl_class"), "{}", other.err);
    let other = json(&folder.path().join("run/evaluation-a2rl_class-both-3.json"));
    assert!(other["vehicle"] == "a2rl_class" && other["trained_vehicle"] == "seed_class", "{other}");

    let unmet = racer(folder.path(), &["eval", "run", "--require", "0.95"]);
    assert_eq!(unmet.code, 4, "{}", unmet.err);
    assert!(unmet.err.contains("95.0 % are required"));
    assert_eq!(racer(folder.path(), &["eval", "run", "--require", "0", "--agents", "1"]).code, 0);
}

#[test]
fn latest_is_the_youngest_run() {
    let folder = tempfile::tempdir().unwrap();
    let none = racer(folder.path(), &["eval", "latest"]);
    assert!(none.code == 2 && none.err.contains("train first"), "{}", none.err);
    let ran = racer(folder.path(), &TINY[..16]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let run = std::fs::read_dir(folder.path().join("runs")).unwrap().next().unwrap().unwrap().path();
    assert!(run.to_str().unwrap().ends_with("Z-square"), "{}", run.display());
    assert_eq!(racer(folder.path(), &["eval", "latest", "--agents", "3"]).code, 0);
    assert!(run.join("evaluation-both-3.json").is_file());
    assert_eq!(racer(folder.path(), &["report", "latest"]).code, 0);
    assert!(run.join("report/report.html").is_file());
    let finished = racer(folder.path(), &["train", "--resume", "latest"]);
    assert!(finished.code == 0 && finished.err.contains("is finished"), "{}", finished.err);
}

#[test]
fn bad_input_is_refused_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bad.toml"), "[ppo]\nlerning_rate = 1\n").unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    std::fs::create_dir(folder.path().join("full")).unwrap();
    std::fs::write(folder.path().join("full/precious"), "x").unwrap();
    for (args, parts) in [
        (&["train", "--config", "bad.toml"][..], &["bad.toml:2", "ppo.lerning_rate", "`ppo.learning_rate`"][..]),
        (&["train", "--set", "ppo.clip=wide"], &["--set ppo.clip=wide", "a number"]),
        (&["train", "--set", "ppo.gamma=1.5"], &["ppo.gamma", "0 to 1"]),
        (&["train", "--set", "ppo.minibatches=7"], &["ppo.minibatches", "4 and 8"]),
        (&["train", "--track", "monza"], &["track `monza`"]),
        (&["train", "--minutes", "-1"], &["--minutes -1", "budget.minutes", "above 0"]),
        (&["train", "--minutes", "1", "--steps", "5"], &["--minutes", "--steps"]),
        (&["train", "--threads", "0"], &["--threads", "1 to 1024"]),
        (&["train", "--out", "full"], &["full", "nothing existing is overwritten"]),
        (&["train", "--out", "file"], &["file", "choose another path"]),
        (&["train", "--out", "file/run"], &["file/run", "choose another path"]),
        (&["eval", "nowhere"], &["nowhere", "a run folder"]),
        (&["eval", "bad.toml"], &["bad.toml", "a policy snapshot"]),
        (&["eval", "full"], &["full", "policy.safetensors"]),
        (&["eval", "nowhere", "--start", "random", "--require", "0.9"], &["--require", "fixed starts"]),
        (&["bench", "--seconds", "-1"], &["--seconds"]),
        (&["eval", "nowhere", "--vehicle"], &["--vehicle"]),
        (&["fly", "--out", "log.mcap"], &["--pilot"]),
        (&["fly", "--pilot"], &["--out"]),
        (&["fly", "nowhere", "--pilot", "--out", "log.mcap"], &["--pilot"]),
        (&["fly", "nowhere", "--out", "log.mcap"], &["nowhere", "a run folder"]),
        (&["fly", "--pilot", "--out", "full/precious"], &["full/precious", "nothing existing is overwritten"]),
        (&["fly", "--pilot", "--out", "none/log.mcap"], &["none/log.mcap", "choose another path"]),
        (&["fly", "--pilot", "--sensors", "idael", "--out", "log.mcap"], &["sensors `idael`", "`ideal`"]),
        (&["fly", "--pilot", "--vehicle", "kite", "--out", "log.mcap"], &["vehicle `kite`"]),
        (&["fly", "--pilot", "--manoeuvres", "punhc", "--out", "log.mcap"], &["punhc", "`punch`"]),
        (&["fly", "--pilot", "--seconds", "5", "--out", "log.mcap"], &["--seconds", "40 to 3600 s"]),
        (&["fly", "--pilot", "--seconds", "-5", "--out", "log.mcap"], &["--seconds", "0.1 to 3600"]),
    ] {
        let ran = racer(folder.path(), args);
        assert_eq!(ran.code, 2, "{args:?}: {}", ran.err);
        assert!(ran.out.is_empty(), "{args:?}: {}", ran.out);
        for part in parts {
            assert!(ran.err.contains(part), "{args:?}: `{part}` is not in:\n{}", ran.err);
        }
    }
    assert!(!folder.path().join("runs").exists() && !folder.path().join("log.mcap").exists());
    assert_eq!(std::fs::read(folder.path().join("full/precious")).unwrap(), b"x");
}

#[test]
fn outputs_that_cannot_be_written_fail_before_the_work() {
    let folder = trained();
    std::fs::write(folder.path().join("e.json"), "precious").unwrap();
    for out in ["e.json", "none/e.json"] {
        let ran = racer(folder.path(), &["eval", "run", "--out", out]);
        assert!(ran.code == 2 && ran.out.is_empty() && ran.err.contains(out), "{}", ran.err);
    }
    assert_eq!(std::fs::read(folder.path().join("e.json")).unwrap(), b"precious");
}

#[cfg(unix)]
#[test]
fn ctrl_c_finishes_the_update_and_saves() {
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};
    let folder = tempfile::tempdir().unwrap();
    let mut args = TINY.to_vec();
    args[2] = "--minutes=10";
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("racer"))
        .current_dir(folder.path())
        .args(args)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut err = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("steps/s") {
        line.clear();
        assert!(err.read_line(&mut line).unwrap() > 0, "the training ended by itself");
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let rest: Vec<String> = err.lines().map(Result::unwrap).collect();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(rest.iter().any(|line| line.contains("racer eval run")), "{rest:?}");
    assert_eq!(racer(folder.path(), &["eval", "run", "--agents", "2"]).code, 0);
    assert!(folder.path().join("run/metrics.csv").is_file());
}

/// Half of a comparison is none: it ends with a sentence and the exit code of an interruption.
#[cfg(unix)]
#[test]
fn ctrl_c_in_the_first_of_two_trainings_leaves_no_comparison() {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Command, Stdio};
    let folder = tempfile::tempdir().unwrap();
    let fly = ["fly", "--pilot", "--seconds", "40", "--vehicle", "seed_class", "--out", "flight.mcap"];
    assert_eq!(racer(folder.path(), &fly).code, 0);
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("racer"))
        .current_dir(folder.path())
        .args(["diagnose", "flight.mcap", "--vehicle", "seed_class", "--retrain", "10"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut err = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("steps/s") {
        line.clear();
        assert!(err.read_line(&mut line).unwrap() > 0, "the training ended by itself");
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let (mut rest, mut out) = (String::new(), String::new());
    err.read_to_string(&mut rest).unwrap();
    child.stdout.take().unwrap().read_to_string(&mut out).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(rest.contains("no comparison") && rest.contains("retrained"), "{rest}");
    assert!(!out.contains("trained in the"), "no table of trainings: {out}");
    assert!(folder.path().join("retrained/base/metrics.csv").is_file(), "what was trained is kept");
    assert!(!folder.path().join("retrained/extended").exists());
}

#[test]
fn bench_has_the_keys_that_it_promises() {
    let folder = tempfile::tempdir().unwrap();
    let ran = racer(folder.path(), &["bench", "--json", "--seconds", "0.01", "--threads", "2"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let figures: Value = serde_json::from_str(&ran.out).unwrap();
    for key in ["physics_steps_per_s", "rollout_steps_per_s", "training_steps_per_s"] {
        for threads in ["one_thread", "all_threads"] {
            assert!(figures[key][threads].as_f64().unwrap() > 0.0, "{key}.{threads}");
        }
    }
    assert!(figures["peak_flops_per_s"].as_f64().unwrap() > 0.0);
    assert!((0.0..=1.0).contains(&figures["training_peak_share"].as_f64().unwrap()));
    assert!(figures["round_trip_s"].as_f64().unwrap() > 0.0);
    assert_eq!(figures["threads"], 2);
    assert!(figures["simd"].is_string());
}

#[test]
fn bench_tells_the_parts_of_a_step_and_predicts_more_threads() {
    let folder = tempfile::tempdir().unwrap();
    let options = ["bench", "--parts", "--threads-model", "--seconds", "0.01", "--threads", "2"];
    let text = racer(folder.path(), &options);
    for part in ["Adam", "gather", "multiply-adds at the peak", "threads", "64"] {
        assert!(text.out.contains(part), "{part}: {}{}", text.out, text.err);
    }
    let ran = racer(folder.path(), &[&options[..], &["--json"]].concat());
    let figures: Value = serde_json::from_str(&ran.out).unwrap();
    let predicted = figures["predicted"].as_array().unwrap();
    assert_eq!((predicted.len(), &predicted[0]["threads"]), (7, &1.into()));
    assert!(figures["step_parts_s"]["backward"].as_f64().unwrap() > 0.0, "{figures}");
    assert_eq!(figures["chunks"], 4);
}

#[test]
fn help_names_the_exit_codes() {
    let folder = tempfile::tempdir().unwrap();
    let ran = racer(folder.path(), &["--help"]);
    assert!(ran.code == 0 && ran.out.contains("130") && ran.out.contains("--require"));
    let ran = racer(folder.path(), &["train", "--help"]);
    assert!(ran.out.contains("adam_epsilon") && ran.out.contains("budget"), "all keys are listed: {}", ran.out);
    for command in ["train", "eval", "fly", "bench", "study", "report"] {
        assert_eq!(racer(folder.path(), &[command, "--help"]).code, 0);
    }
}
