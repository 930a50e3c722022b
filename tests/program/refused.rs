//! What `identify`, `predict` and `diagnose` refuse before their work begins: logs that do not go together, and files
//! that cannot be written.

use crate::support::{self, Ran};
use racer::flight::{self, Log};
use std::path::Path;

fn racer(folder: &Path, args: &str) -> Ran {
    support::racer(folder, &args.split(' ').collect::<Vec<_>>())
}

/// A flight of 40 s as `name`.
fn fly(folder: &Path, more: &str, name: &str) {
    let ran = racer(folder, &format!("fly --pilot --seconds 40 --out {name}{more}"));
    assert_eq!(ran.code, 0, "{}", ran.err);
}

/// Names of what is in a folder.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_flight_is_not_counted_twice() {
    let folder = tempfile::tempdir().unwrap();
    fly(folder.path(), "", "a.mcap");
    std::fs::copy(folder.path().join("a.mcap"), folder.path().join("b.mcap")).unwrap();
    for args in [
        "identify a.mcap a.mcap --out x.toml",
        "identify a.mcap b.mcap --despite-problems --out x.toml",
        "predict a.mcap b.mcap --vehicle seed_class",
        "diagnose a.mcap b.mcap",
        "diagnose a.mcap --against b.mcap",
    ] {
        let ran = racer(folder.path(), args);
        assert!(ran.code == 2 && ran.err.contains("the same flight as "), "{args}: {}", ran.err);
        assert!(ran.out.is_empty(), "{args}: {}", ran.out);
    }
    assert_eq!(names(folder.path()), ["a.mcap", "b.mcap"]);
}

#[test]
fn flights_of_two_vehicles_are_not_fitted_together() {
    let folder = tempfile::tempdir().unwrap();
    fly(folder.path(), "", "a.mcap");
    let save = |name: &str, change: &dyn Fn(&mut Log)| {
        let mut log = flight::open(&folder.path().join("b.mcap"), None).unwrap();
        change(&mut log);
        log.save(folder.path().join(name)).unwrap();
    };
    fly(folder.path(), " --seed 2", "b.mcap");
    save("heavy.mcap", &|log| log.vehicle.mass_kg = Some(1.3));
    save("fast.mcap", &|log| log.vehicle.max_rate_rad_s = Some([12.0, 12.0, 6.0]));
    save("other.mcap", &|log| log.vehicle.kind = None);
    for (args, said) in [
        ("identify a.mcap heavy.mcap --out x.toml", "a mass of 1.3 kg, and a mass of 1 kg of a.mcap"),
        ("identify a.mcap fast.mcap --mass 1 --out x.toml", "full-stick rates of 688, 688, 344 deg/s, and"),
        ("identify a.mcap other.mcap --out x.toml", "of no known kind, and a.mcap of a multirotor"),
        ("diagnose a.mcap heavy.mcap --vehicle seed_class", "a mass of 1.3 kg"),
        ("diagnose a.mcap fast.mcap", "full-stick rates"),
        ("diagnose a.mcap --against other.mcap", "of a vehicle of no known kind"),
    ] {
        let ran = racer(folder.path(), args);
        assert!(ran.code == 2 && ran.err.contains(said), "{args}: {}", ran.err);
        assert!(ran.err.contains("one vehicle") && ran.err.contains("--despite-problems"), "{args}: {}", ran.err);
    }
    assert!(!folder.path().join("x.toml").exists());
    let ran = racer(folder.path(), "identify a.mcap heavy.mcap --mass 1.3 --out x.toml");
    assert_eq!(ran.code, 0, "{}", ran.err);
}

#[test]
fn a_log_with_nothing_in_it_is_not_gone_on_with() {
    let folder = tempfile::tempdir().unwrap();
    fly(folder.path(), "", "a.mcap");
    let mut log = flight::open(&folder.path().join("a.mcap"), None).unwrap();
    let rows = log.imu.time_s.partition_point(|t| *t < 2.0);
    log.imu.time_s.truncate(rows);
    log.imu.rows.truncate(rows);
    log.save(folder.path().join("short.mcap")).unwrap();
    let ran = racer(folder.path(), "identify short.mcap --out x.toml");
    assert!(ran.code == 2 && ran.err.contains("give another log"), "{}", ran.err);
    assert!(!ran.err.contains("--despite-problems"), "{}", ran.err);
}

#[test]
fn two_files_of_one_path_are_refused_before_anything_is_read() {
    let folder = tempfile::tempdir().unwrap();
    for (args, said) in [
        ("diagnose no.mcap --report a.html --json a.html", ["the path of --json", "(--report)"]),
        ("diagnose no.mcap --report a.html --extend ./a.html", ["the path of --extend", "(--report)"]),
        ("diagnose no.mcap --report a --svg a", ["the path of --report", "(--svg)"]),
        ("identify no.mcap --out x.toml --validated x.toml", ["the path of --out", "(--validated)"]),
        ("identify no.mcap --out nowhere/x.toml", ["a folder that can be written to", "(--out)"]),
        ("diagnose no.mcap --json nowhere/x.json", ["a folder that can be written to", "(--json)"]),
    ] {
        let ran = racer(folder.path(), args);
        assert!(ran.code == 2 && said.iter().all(|said| ran.err.contains(said)), "{args}: {}", ran.err);
    }
    assert!(names(folder.path()).is_empty(), "{:?}", names(folder.path()));
}

#[test]
fn a_vehicle_that_is_given_needs_no_base() {
    let folder = tempfile::tempdir().unwrap();
    let ran = racer(folder.path(), "diagnose no.mcap --vehicle seed_class --base a2rl_class");
    assert!(ran.code == 2 && ran.err.contains("--base") && ran.err.contains("cannot be used with"), "{}", ran.err);
    let ran = racer(folder.path(), "diagnose no.mcap --vehicle seed_class");
    assert!(ran.code == 2 && ran.err.contains("no.mcap") && ran.err.contains("to do"), "{}", ran.err);
}
