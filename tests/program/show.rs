//! `racer track`, `racer replay` and `racer eval --sensitivity` as a user meets them.

use crate::support::racer;
use serde_json::Value;

#[test]
fn a_track_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let ran = racer(folder.path(), &["track", "show", "square", "--svg", "square.svg"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.out.contains("reset spline") && ran.out.contains("fresh battery"), "{}", ran.out);
    assert!(std::fs::read_to_string(folder.path().join("square.svg")).unwrap().contains("reference lap of seed_class"));
    // Nothing existing is overwritten.
    assert_eq!(racer(folder.path(), &["track", "show", "square", "--svg", "square.svg"]).code, 2);

    let ran = racer(folder.path(), &["track", "show", "square", "--json"]);
    let shown: Value = serde_json::from_str(&ran.out).unwrap();
    assert_eq!(shown["gates"].as_array().unwrap().len(), 4);
    let laps = shown["reference_laps"].as_array().unwrap();
    let seconds = |i: usize| laps[i]["seconds"].as_f64().unwrap();
    assert!(seconds(0) > 1.0 && seconds(0) < seconds(1) && seconds(1) < 2.0, "{laps:?}");
    let shape = &shown["reset_spline"];
    assert!(shape["length_m"].as_f64().unwrap() > 12.0 && shape["curvature_1_m"].as_f64().unwrap() > 0.4, "{shape}");

    let ran = racer(folder.path(), &["track", "show", "sqare"]);
    assert!(ran.code == 2 && ran.err.contains("square"), "{}", ran.err);
}

#[test]
fn a_policy_is_replayed_and_its_sensitivity_told() {
    let folder = tempfile::tempdir().unwrap();
    let tiny = [
        "train",
        "--track=square",
        "--steps=4000",
        "--set=ppo.environments=64",
        "--set=ppo.rollout=16",
        "--set=ppo.minibatches=2",
        "--set=eval.agents=20",
        "--set=eval.max_steps=100",
        "--set=budget.snapshots=1",
        "--out=run",
    ];
    let ran = racer(folder.path(), &tiny);
    assert_eq!(ran.code, 0, "{}", ran.err);

    let ran = racer(folder.path(), &["replay", "run", "--agents", "3"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(ran.out.lines().count(), 3, "{}", ran.out);
    for name in ["replay.html", "replay.mcap", "foxglove-layout.json"] {
        assert!(folder.path().join("run/replay").join(name).is_file(), "{name}");
    }
    // A second one stands beside the first.
    assert_eq!(racer(folder.path(), &["replay", "run"]).code, 0);
    assert!(folder.path().join("run/replay-2/replay.html").is_file());
    assert_eq!(racer(folder.path(), &["replay", "run", "--out", "run"]).code, 2);
    assert_eq!(racer(folder.path(), &["replay", "run", "--mapping", "px4"]).code, 2);

    let ran = racer(folder.path(), &["report", "run", "--beside", "run"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let page = std::fs::read_to_string(folder.path().join(ran.out.trim())).unwrap();
    assert!(
        page.contains("run, random start")
            && page.contains("Health of the training")
            && page.matches("<svg").count() == 5,
        "{page}"
    );
    for (figure, part) in [
        ("training", "seed 1"),
        ("lap", "no lap"),
        ("commands", "thrust"),
        ("spread", "randomised"),
        ("health", "explained"),
    ] {
        let svg = std::fs::read_to_string(folder.path().join(format!("run/report/{figure}.svg"))).unwrap();
        assert!(svg.contains(part), "{figure}");
    }
    assert_eq!(racer(folder.path(), &["report", "run", "--beside", "nowhere"]).code, 2);

    let ran = racer(folder.path(), &["fly", "run", "--seconds", "1", "--out", "log.mcap"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let ran = racer(folder.path(), &["replay", "log.mcap", "--track", "square"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(folder.path().join("log-replay/replay.html").is_file());
    let ran = racer(folder.path(), &["replay", "log.mcap", "--agents", "2"]);
    assert!(ran.code == 2 && ran.err.contains("--agents"), "{}", ran.err);

    let ran = racer(folder.path(), &["eval", "run", "--sensitivity", "--agents", "8", "--json"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let told: Value = serde_json::from_str(&ran.out).unwrap();
    let rows = told["parameters"].as_array().unwrap();
    assert_eq!(rows.len(), 10);
    for row in rows {
        let cells = row["cells"].as_array().unwrap();
        assert_eq!(cells.len(), 11, "{row}");
        let nominal = cells.iter().find(|cell| cell["value"] == 1.0).unwrap();
        assert_eq!(nominal, &told["nominal"], "the nominal vehicle is part of every row");
    }
    assert!(folder.path().join("run/sensitivity-8.json").is_file());
    assert_eq!(racer(folder.path(), &["eval", "run", "--sensitivity", "--require", "0.5"]).code, 2);
}
