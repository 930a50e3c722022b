//! `racer diagnose --plan`, and the flight that it plans.

use crate::support;
use racer::flight::planned::FlightPlan;
use std::path::Path;

fn racer(folder: &Path, args: &str) -> support::Ran {
    support::racer(folder, &args.split(' ').collect::<Vec<_>>())
}

#[test]
fn a_flight_of_few_manoeuvres_is_followed_by_one_that_the_pilot_flies() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let run = |args: &str| racer(folder.path(), args);
    let ran = run("fly --pilot --manoeuvres circle --seconds 45 --out flight.mcap");
    assert_eq!(ran.code, 0, "{}", ran.err);
    let ran = run("diagnose flight.mcap --vehicle seed_class --plan-out plan.toml --json out.json");
    assert_eq!(ran.code, 0, "{}", ran.err);
    for part in ["these flights could show", "or nothing", "fly next", "racer fly --pilot --plan plan.toml"] {
        assert!(ran.out.contains(part), "`{part}` is not in:\n{}", ran.out);
    }
    let plan = FlightPlan::read(&path("plan.toml")).unwrap();
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(path("out.json")).unwrap()).unwrap();
    let names = json["plan"]["manoeuvres"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap());
    assert_eq!(names.collect::<Vec<_>>(), plan.manoeuvre.iter().map(|m| m.name.as_str()).collect::<Vec<_>>());

    // Nothing is written over, and that is known before the work.
    let ran = run("diagnose flight.mcap --vehicle seed_class --plan-out plan.toml");
    assert!(ran.code == 2 && ran.err.contains("nothing existing is overwritten"), "{}", ran.err);

    // A short one of the same making, so that a pack carries it.
    let short = FlightPlan { manoeuvre: vec![plan.manoeuvre[0].clone()] };
    let short = FlightPlan {
        manoeuvre: short
            .manoeuvre
            .into_iter()
            .map(|m| racer::flight::planned::PlannedManoeuvre { count: 2, ..m })
            .collect(),
    };
    std::fs::write(path("short.toml"), toml::to_string(&short).unwrap()).unwrap();
    let ran = run("fly --pilot --plan short.toml --out next.mcap");
    assert!(ran.code == 0 && !ran.err.contains("landed after"), "{}", ran.err);
    let ran = run("fly --pilot --plan plan.toml --seconds 45 --out cut.mcap");
    assert!(ran.code == 0, "{}", ran.err);

    std::fs::write(path("bad.toml"), "[[manoeuvre]]\nname = \"dives\"\ncount = 1\n").unwrap();
    let ran = run("fly --pilot --plan bad.toml --out other.mcap");
    assert_eq!(ran.code, 2);
    for part in ["bad.toml:2", "dives", "did you mean `dive`?"] {
        assert!(ran.err.contains(part), "`{part}` is not in:\n{}", ran.err);
    }
    let ran = run("fly --pilot --plan plan.toml --manoeuvres dive --out other.mcap");
    assert!(ran.code == 2 && ran.err.contains("cannot be used with"), "{}", ran.err);
}
