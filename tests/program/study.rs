//! Studies as a user meets them: what a file spans, what is refused before anything starts, and that interruptions
//! leave no trace in the tables.

#[cfg(unix)]
mod slurm;

use crate::support::racer;
use racer::base::check::BadInput;
use racer::base::document::Document;
use racer::present::study::Study;
use racer::present::study::plan::{Planned, StudyBudget, plan};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Four runs of a second at most.
pub const TINY: &str = "
steps = 4000
seeds = 2
agents = 8

[set]
track = 'square'
ppo.environments = 64
ppo.minibatches = 2
ppo.epochs = 1
eval.max_steps = 60
budget.snapshots = 2

[grid]
ppo.rollout = [16, 32]
";

fn planned(text: &str) -> Result<Planned, BadInput> {
    let document = Document::parse("study.toml", text)?;
    plan("study.toml", &document, &Study::of(&document)?, StudyBudget::default())
}

fn with_study(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("tiny.toml"), text).unwrap();
    folder
}

/// The tables that are to repeat.
fn tables(study: &Path) -> BTreeMap<&'static str, Vec<u8>> {
    let names = ["runs.csv", "settings.csv", "axes.csv", "ranking.csv", "results.json"];
    names.map(|name| (name, std::fs::read(study.join(name)).unwrap())).into()
}

fn runs(study: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(study.join("runs")).into_iter().flatten().flatten();
    let mut runs: Vec<_> = entries.map(|entry| entry.path()).collect();
    runs.sort();
    runs
}

#[test]
fn grids_groups_and_seeds_are_crossed() {
    let text = "
        seeds = [3, 5]
        minutes = 0.5
        [set]
        env.reward.gate = 9.0
        [cases.rollout]
        small = { 'ppo.environments' = 64, 'ppo.rollout' = 16 }
        large = { 'ppo.environments' = 128, 'ppo.rollout' = 32 }
        [grid]
        'ppo.epochs' = [1, 2]
        ppo.minibatches = [4, 8, 16]
    ";
    let Planned { plan, runs, .. } = planned(text).unwrap();
    assert_eq!((plan.settings.len(), plan.runs.len()), (12, 24));
    assert_eq!(plan.axes, ["rollout", "epochs", "minibatches"]);
    assert_eq!(plan.settings[0].name, "small,epochs=1,minibatches=4");
    // The last axis varies fastest, then seeds.
    assert_eq!(plan.settings[11].levels, ["large", "2", "16"]);
    assert_eq!((plan.runs[12].name.as_str(), plan.runs[12].seed), ("small,epochs=1,minibatches=4,seed=5", 5));
    let config = &runs[12 + 11].1.config;
    assert_eq!((config.ppo.environments, config.ppo.rollout, config.ppo.epochs), (128, 32, 2));
    assert_eq!((config.ppo.minibatches, config.seed, config.budget.minutes), (16, 5, Some(0.5)));
    assert_eq!(config.env.reward.gate, 9.0);
    let names: std::collections::BTreeSet<_> = plan.runs.iter().map(|run| &run.name).collect();
    assert_eq!(names.len(), 24);
}

#[test]
fn the_simplest_study_is_its_configuration() {
    let Planned { plan, runs, .. } = planned("").unwrap();
    assert_eq!((plan.runs.len(), plan.runs[0].name.as_str()), (1, "base,seed=1"));
    assert_eq!(runs[0].1, racer::race::config::Setup::load("a2rl", &[]).unwrap());
}

#[test]
fn shipped_studies_hold_what_they_say() {
    for (name, settings, runs) in [
        ("paper_configurations", 96, 96),
        ("cpu_configurations", 24, 48),
        ("seeds_paper", 3, 96),
        ("seeds", 2, 16),
        ("regularisation", 2, 8),
        ("regularisation_factorial", 8, 24),
        ("entropy", 6, 12),
    ] {
        let (document, study) = Study::open(name).unwrap();
        let plan = plan(name, &document, &study, StudyBudget::default()).unwrap().plan;
        assert_eq!((plan.settings.len(), plan.runs.len()), (settings, runs), "{name}");
    }
}

#[test]
fn what_is_wrong_is_refused_with_its_name() {
    for (text, parts) in [
        ("[grid]\nppo.minibatches = [64, 7]", &["minibatches=7", "study.toml:2", "ppo.minibatches", "4 and 8"][..]),
        ("[grid]\nppo.lerning_rate = [1e-3]", &["ppo.lerning_rate", "`ppo.learning_rate`"]),
        ("[grid]\nppo.clip = ['wide']", &["clip=wide", "ppo.clip", "a number"]),
        ("[grid]\nppo.clip = 0.2", &["study.toml:2", "a list of values", "[set]"]),
        ("[grid]\nppo.clip = []", &["clip", "at least one value"]),
        ("[grid]\nppo.clip = [0.2, 0.2]", &["0.2 twice"]),
        ("[grid]\nseed = [1, 2]", &["seed", "`seeds`"]),
        ("[set]\nbudget.minutes = 3", &["budget.minutes", "`minutes`"]),
        ("[set]\nppo.clip = 0.1\n[grid]\nppo.clip = [0.2]", &["ppo.clip", "set and by clip", "take one out"]),
        ("agents = 3\n[set]\neval.agents = 4", &["eval.agents", "agents and by set"]),
        ("[cases]\nrollout = [1]", &["cases.rollout", "[cases.GROUP]"]),
        ("[cases.a]\nx = 3", &["cases.a.x", "a table of keys"]),
        ("seeds = 0", &["seeds", "seeds = 8"]),
        ("seeds = [1, 1]", &["seeds", "different"]),
        ("seeds = [-1]", &["seeds", "zero or more"]),
        ("minutes = 1\nsteps = 2", &["either minutes or steps"]),
        ("minutes = -1", &["minutes", "above 0"]),
        ("section_share = 0", &["section_share", "above 0"]),
        ("jobs = 0", &["jobs", "1 to 1024"]),
        ("gird = 3", &["gird", "`grid`"]),
        ("config = 'none'", &["setting base", "none"]),
        ("[set]\ntrack = 'monza'", &["setting base", "track `monza`"]),
    ] {
        let error = planned(text).map(|_| ()).unwrap_err().to_string();
        for part in parts {
            assert!(error.contains(part), "{text}: `{part}` is not in:\n{error}");
        }
    }
}

#[test]
fn a_bad_study_starts_nothing() {
    let folder = with_study(&TINY.replace("[16, 32]", "[16, 32, 0]"));
    let ran = racer(folder.path(), &["study", "tiny.toml"]);
    assert!(ran.code == 2 && ran.err.contains("rollout=0") && ran.out.is_empty(), "{}", ran.err);
    assert!(!folder.path().join("runs").exists());
    for (args, part) in [
        (&["study", "tinny.toml"][..], "no such file"),
        (&["study", "tiny.toml", "--shard", "3/2"], "K/N"),
        (&["study", "tiny.toml", "--jobs", "1000"], "processors"),
        (&["study", "tiny.toml", "--minutes", "0"], "above 0"),
        (&["report", "."], "another folder"),
        (&["report", "nowhere"], "nothing of that name"),
    ] {
        std::fs::write(folder.path().join("tiny.toml"), TINY).unwrap();
        let ran = racer(folder.path(), args);
        assert!(ran.code == 2 && ran.err.contains(part), "{args:?}: {}", ran.err);
    }
    std::fs::create_dir(folder.path().join("full")).unwrap();
    std::fs::write(folder.path().join("full/precious"), "x").unwrap();
    let ran = racer(folder.path(), &["study", "tiny.toml", "--out", "full"]);
    assert!(ran.code == 2 && ran.err.contains("something else"), "{}", ran.err);
    assert_eq!(std::fs::read_dir(folder.path().join("full")).unwrap().count(), 1);
}

/// Shards make disjoint parts, the parts make the whole, and any process makes the same tables of it; so does a study
/// whose process was killed, without making a finished run again.
#[test]
fn shards_and_kills_leave_the_same_tables() {
    let folder = with_study(TINY);
    let whole = racer(folder.path(), &["study", "tiny.toml", "--json", "all.json"]);
    assert_eq!(whole.code, 0, "{}", whole.err);
    let study = folder.path().join("runs/tiny");
    let expected = tables(&study);
    assert_eq!(std::fs::read(folder.path().join("all.json")).unwrap(), expected["results.json"]);
    let document: Value = serde_json::from_slice(&expected["results.json"]).unwrap();
    assert_eq!((document["finished"].as_u64(), document["ranking"].as_array().unwrap().len()), (Some(4), 2));
    assert!(
        document["ranking"][0]["best"].is_number() && document["settings"][1]["metrics"]["top_speed_m_s"]["n"] == 2
    );
    let table = String::from_utf8(expected["runs.csv"].clone()).unwrap();
    assert!(table.starts_with("run,setting,rollout,seed,fixed_completion,"), "{table}");
    assert!(
        table.contains("\nrollout=32,seed=2,rollout=32,32,2,")
            || table.contains("\"rollout=32,seed=2\",rollout=32,32,2,"),
        "{table}"
    );
    assert!(whole.out.contains("4 of 4 runs") && whole.out.contains("rollout=16"), "{}", whole.out);

    let shard = |k: &str| racer(folder.path(), &["study", "tiny.toml", "--out", "shared", "--shard", k]);
    assert_eq!(shard("1/2").code, 0);
    let shared = folder.path().join("shared");
    let first = runs(&shared);
    assert_eq!(first.len(), 2);
    assert_eq!(shard("2/2").code, 0);
    assert!(runs(&shared).len() == 4 && first.iter().all(|run| runs(&shared).contains(run)));
    assert_eq!(tables(&shared), expected);

    let killed = folder.path().join("killed");
    // Killed in its first, second and third run.
    for done in 0..3 {
        let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("racer"))
            .current_dir(folder.path())
            .args(["study", "tiny.toml", "--out", "killed"])
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        let work = || std::fs::read_dir(killed.join(".work")).into_iter().flatten().flatten().count();
        while runs(&killed).len() < done || work() == 0 {
            assert!(child.try_wait().unwrap().is_none(), "it ended before it could be killed");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let made = |run: &PathBuf| std::fs::metadata(run.join("result.json")).unwrap().modified().unwrap();
    let before: Vec<_> = runs(&killed).into_iter().map(|run| (made(&run), run)).collect();
    let again = racer(folder.path(), &["study", "tiny.toml", "--out", "killed"]);
    assert_eq!(again.code, 0, "{}", again.err);
    assert_eq!(tables(&killed), expected);
    assert!(before.len() >= 2 && before.iter().all(|(time, run)| made(run) == *time));
    assert_eq!(std::fs::read_dir(killed.join(".work")).unwrap().count(), 0, "nothing is left behind");

    // Nothing is left to do, and the report draws it.
    let idle = racer(folder.path(), &["study", "tiny.toml", "--out", "killed"]);
    assert!(idle.code == 0 && idle.out == whole.out && !idle.err.contains("begins"), "{}", idle.err);
    let report = racer(folder.path(), &["report", "killed"]);
    assert_eq!(report.code, 0, "{}", report.err);
    let page = std::fs::read_to_string(folder.path().join(report.out.trim())).unwrap();
    assert!(page.matches("<svg").count() == 4 && page.contains("rollout=32"));
    for figure in ["ranking", "learning-curves", "seed-bands-completion", "seed-bands-learning"] {
        let svg = std::fs::read_to_string(killed.join(format!("report/{figure}.svg"))).unwrap();
        assert!(svg.contains("<svg") && !svg.contains("NaN"), "{figure}");
    }

    changed_studies_are_noticed(folder.path());
}

/// A run is never reused for another configuration than its own; what a study adds is made, and nothing else.
fn changed_studies_are_noticed(folder: &Path) {
    let study = |text: &str, args: &[&str]| {
        std::fs::write(folder.join("tiny.toml"), text).unwrap();
        racer(folder, &[&["study", "tiny.toml", "--out", "killed"][..], args].concat())
    };
    let changed = study(&TINY.replace("epochs = 1", "epochs = 2"), &[]);
    assert_eq!(changed.code, 2, "{}", changed.err);
    for part in ["rollout=16,seed=1", "[ppo] epochs = 1", "[ppo] epochs = 2", "--out"] {
        assert!(changed.err.contains(part), "`{part}` is not in:\n{}", changed.err);
    }
    let steps = study(TINY, &["--steps", "5000"]);
    assert!(steps.code == 2 && steps.err.contains("5000"), "{}", steps.err);
    let list = study(&TINY.replace("seeds = 2", "seeds = 3"), &["--list"]);
    assert_eq!((list.out.matches("finished").count(), list.out.matches("to do").count()), (4, 2), "{}", list.out);
    let more = study(&TINY.replace("seeds = 2", "seeds = 3"), &[]);
    assert!(more.code == 0 && more.err.matches("begins").count() == 2, "{}", more.err);
    assert!(more.out.contains("6 of 6 runs"), "{}", more.out);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_run_and_says_how_to_go_on() {
    use std::io::{BufRead, BufReader};
    let folder = with_study(&TINY.replace("steps = 4000", "minutes = 10"));
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("racer"))
        .current_dir(folder.path())
        .args(["study", "tiny.toml"])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut err = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    err.read_line(&mut line).unwrap();
    assert!(line.contains("begins"), "{line}");
    let interrupt = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupt.unwrap().success());
    let rest: Vec<String> = err.lines().map(Result::unwrap).collect();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{rest:?}");
    assert!(rest.iter().any(|line| line.contains("racer study tiny.toml --out runs/tiny")), "{rest:?}");
    assert!(runs(&folder.path().join("runs/tiny")).is_empty());
    // Interrupted early enough, it has no such folder yet.
    assert_eq!(std::fs::read_dir(folder.path().join("runs/tiny/.work")).map_or(0, Iterator::count), 0);
}

/// A training that crashes is told, takes nothing along, and is made by the next start.
#[cfg(target_os = "linux")]
#[test]
fn a_crash_takes_nothing_along() {
    let folder = with_study(&TINY.replace("4000", "60000").replace("seeds = 2", "seeds = 1"));
    let study = std::process::Command::new(assert_cmd::cargo::cargo_bin("racer"))
        .current_dir(folder.path())
        .args(["study", "tiny.toml"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let training = loop {
        if let Some(child) = child_of(study.id()) {
            break child;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    };
    assert!(std::process::Command::new("kill").args(["-KILL", &training.to_string()]).status().unwrap().success());
    let output = study.wait_with_output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.contains("rollout=16,seed=1 failed: signal: 9") && err.contains("tries them again"), "{err}");
    assert!(String::from_utf8(output.stdout).unwrap().contains("1 of 2 runs"));
    let again = racer(folder.path(), &["study", "tiny.toml"]);
    assert!(again.code == 0 && again.err.matches("begins").count() == 1, "{}", again.err);
    assert!(again.out.contains("2 of 2 runs"), "{}", again.out);
}

/// A process started by the process `parent`.
#[cfg(target_os = "linux")]
fn child_of(parent: u32) -> Option<u32> {
    let processes = std::fs::read_dir("/proc").unwrap().flatten();
    let ids = processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    // After the name, which may hold anything, come the state and the parent.
    let parent_of = |id: &u32| {
        let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
        stat.rsplit(')').next()?.split_whitespace().nth(1)?.parse::<u32>().ok()
    };
    ids.into_iter().find(|id| parent_of(id) == Some(parent))
}
