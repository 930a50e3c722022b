//! The options of `racer diagnose` that list and scale its criteria.

use crate::support::racer;

#[test]
fn every_criterion_is_listed_with_its_source() {
    let folder = tempfile::tempdir().unwrap();
    let ran = racer(folder.path(), &["diagnose", "--criteria"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let mut reader = csv::Reader::from_reader(ran.out.as_bytes());
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    assert!(rows.iter().any(|row| &row[0] == "LEAST_GAIN" && &row[1] == "30"), "{}", ran.out);
    let help = racer(folder.path(), &["diagnose", "--help"]).out;
    assert!(help.contains("--criteria") && !help.contains("--scale-criterion"), "{help}");
    assert!(rows.iter().all(|row| ["theory", "assumed"].contains(&&row[3]) && !row[4].is_empty()), "{}", ran.out);
}

#[test]
fn a_scaled_criterion_changes_the_answer_and_an_unknown_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| racer(folder.path(), &args.split(' ').collect::<Vec<_>>());
    let mut vehicle = std::fs::read_to_string("configs/vehicles/seed_class.toml").unwrap();
    vehicle.push_str("\n[effects.sizes.axial_inflow]\nk = 0.5\n");
    std::fs::write(folder.path().join("hidden.toml"), vehicle).unwrap();
    let flown = run("fly --pilot --vehicle hidden.toml --seconds 40 --out flight.mcap");
    assert_eq!(flown.code, 0, "{}", flown.err);
    let diagnosed = |more: &str| run(&format!("diagnose flight.mcap --vehicle seed_class --fail-on-effect{more}"));
    assert_eq!(diagnosed("").code, 5);
    // Nothing is evident, no bias matters, and nothing that is left counts.
    let deaf = ["LEAST_GAIN", "MATERIAL_BIAS", "LEFT_OF_NOISE"].map(|name| format!(" --scale-criterion {name}=1e9"));
    let blind = diagnosed(&deaf.concat());
    assert_eq!(blind.code, 0, "{}", blind.err);
    let refused = diagnosed(" --scale-criterion LEAST_GIAN=2");
    assert_eq!(refused.code, 2);
    assert!(refused.err.contains("LEAST_GIAN") && refused.err.contains("--criteria"), "{}", refused.err);
}
