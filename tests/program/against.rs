//! `racer diagnose --against`: what it refuses, and what it leads with.

use crate::support;
use std::path::Path;

fn racer(folder: &Path, args: &str) -> support::Ran {
    support::racer(folder, &args.split(' ').collect::<Vec<_>>())
}

/// A flight of `seed_class` with more in its vehicle file, as `name`.
fn fly(folder: &Path, name: &str, more: &str, seed: u32) {
    let vehicle = std::fs::read_to_string("configs/vehicles/seed_class.toml").unwrap() + more;
    std::fs::write(folder.join("flown.toml"), vehicle).unwrap();
    let ran = racer(folder, &format!("fly --pilot --vehicle flown.toml --seconds 60 --seed {seed} --out {name}"));
    assert_eq!(ran.code, 0, "{}", ran.err);
}

#[test]
fn what_changed_comes_first() {
    let folder = tempfile::tempdir().unwrap();
    let both = "\n[effects.sizes.axial_inflow]\nk = 0.5\n";
    fly(folder.path(), "yesterday.mcap", both, 1);
    fly(folder.path(), "today.mcap", &format!("{both}[effects.sizes.mass_or_density]\nshare = -0.1\n"), 2);
    let again = "--vehicle seed_class --fail-on-change";
    let ran = racer(folder.path(), &format!("diagnose today.mcap --against yesterday.mcap --json out.json {again}"));
    assert_eq!(ran.code, 5, "{}", ran.err);
    assert!(ran.out.starts_with("changed: "), "{}", ran.out);
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("out.json")).unwrap()).unwrap();
    let change = &json["changes"]["changes"][0];
    assert!(["mass_or_density", "thrust"].contains(&change["cause"].as_str().unwrap()), "{change}");
    let both: Vec<&str> =
        json["changes"]["both"].as_array().unwrap().iter().filter_map(|b| b["effect"].as_str()).collect();
    assert!(both.contains(&"axial_inflow"), "{both:?}");

    std::fs::copy(folder.path().join("today.mcap"), folder.path().join("copy.mcap")).unwrap();
    let ran = racer(folder.path(), "diagnose today.mcap --against copy.mcap --vehicle seed_class");
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("the same flight"), "{}", ran.err);
    assert_eq!(racer(folder.path(), "diagnose today.mcap --fail-on-change").code, 2);
}
