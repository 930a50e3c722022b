//! `racer diagnose --report` and `--svg`: what is written, and that nothing is written over.

use crate::support;
use std::path::Path;

fn racer(folder: &Path, args: &str) -> (i32, String) {
    let ran = support::racer(folder, &args.split(' ').collect::<Vec<_>>());
    (ran.code, ran.err)
}

#[test]
fn a_page_names_what_was_hidden_and_shows_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut vehicle = std::fs::read_to_string("configs/vehicles/seed_class.toml").unwrap();
    vehicle.push_str("\n[effects.sizes.axial_inflow]\nk = 0.5\n");
    std::fs::write(path("hidden.toml"), vehicle).unwrap();
    let run = |args: &str| racer(folder.path(), args);
    let (code, err) = run("fly --pilot --vehicle hidden.toml --seconds 60 --out flight.mcap");
    assert_eq!(code, 0, "{err}");

    let (code, err) = run("diagnose flight.mcap --vehicle seed_class --report page.html --svg figures");
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("report in page.html") && err.contains("figures in figures"), "{err}");
    let page = std::fs::read_to_string(path("page.html")).unwrap();
    assert!(page.contains("<title>Diagnosis of flight.mcap</title>"));
    assert!(page.contains("Axial inflow") && page.contains("axial_inflow"));
    assert!(page.matches("<svg").count() >= 4);
    assert!(page.contains("m/s²") && !page.contains("m/s2") && !page.contains("NaN"));
    assert!(!page.contains("http-equiv") && !page.contains("src=") && !page.contains("href="));
    for name in ["specific-force-z-time", "specific-force-z-profile", "specific-force-z-spectrum", "open-loop"] {
        let svg = std::fs::read_to_string(path("figures").join(format!("{name}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
        assert!(page.contains(&svg));
    }

    let (code, err) = run("diagnose flight.mcap --vehicle seed_class --report page.html");
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("another path (--report); nothing existing is overwritten"), "{err}");
    assert_eq!(std::fs::read_to_string(path("page.html")).unwrap(), page);
    let (code, err) = run("diagnose flight.mcap --vehicle seed_class --svg figures");
    assert!(code == 2 && err.contains("another path (--svg); nothing existing is overwritten"), "{err}");
}

#[test]
fn a_vehicle_that_only_the_log_tells_has_the_name_of_its_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("logs")).unwrap();
    let run = |args: &str| racer(folder.path(), args);
    assert_eq!(run("fly --pilot --seconds 60 --out logs/my-5-inch.mcap").0, 0);
    let (code, err) = run("diagnose logs/my-5-inch.mcap --json found.json");
    assert_eq!(code, 0, "{err}");
    let found = std::fs::read(folder.path().join("found.json")).unwrap();
    let found: serde_json::Value = serde_json::from_slice(&found).unwrap();
    assert_eq!(found["base"], "my-5-inch");
}
