//! From a flight to a policy by the commands a user types, and the same flight cut off and contradicting itself.

use crate::support::{self, Ran};
use serde_json::Value;
use std::path::Path;

fn racer(folder: &Path, args: &str) -> (i32, String, String) {
    let Ran { code, out, err } = support::racer(folder, &args.split_whitespace().collect::<Vec<_>>());
    (code, out, err)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn from_a_flight_to_a_policy() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| racer(folder.path(), args);
    let (code, out, err) = run("fly --pilot --seconds 80 --out flight.mcap");
    assert!(code == 0 && out.contains("imu") && err.contains("flight.mcap"), "{out}{err}");

    let (code, out, _) = run("check flight.mcap --json");
    let check: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, check["parameters"].as_array().unwrap().len()), (0, 8));
    assert!(check["parameters"].as_array().unwrap().iter().all(|p| p["why_not"].is_null()), "{out}");

    let (code, out, err) = run("identify flight.mcap --out mine.toml --json mine.json --report mine.html");
    assert!(code == 0 && out.contains("R2") && err.contains("racer train --vehicle mine.toml"), "{out}{err}");
    let found: Value = serde_json::from_slice(&std::fs::read(folder.path().join("mine.json")).unwrap()).unwrap();
    // The seed class flew: configs/vehicles/seed_class.toml.
    for (axis, tau, full) in [("roll", 6.7e-3, 618.0), ("pitch", 12.1e-3, 618.0), ("yaw", 12.4e-3, 120.0f64)] {
        let response = &found["response"][axis];
        assert!((number(&response["tau_s"]["value"]) / tau - 1.0).abs() < 0.05, "{response}");
        assert!(number(&response["r2"]) > 0.95 && number(&response["n_validation"]) > 5000.0, "{response}");
        assert!(["rmse", "mae", "n_train"].iter().all(|key| response[key].is_number()), "{response}");
        let rate = &found["max_rate_rad_s"][axis];
        assert!((number(&rate["value"]) / full.to_radians() - 1.0).abs() < 0.01, "{rate}");
        assert!(number(&rate["low"]) < number(&rate["value"]) && number(&rate["value"]) < number(&rate["high"]));
    }
    assert!((number(&found["response"]["thrust"]["tau_s"]["value"]) / 16.8e-3 - 1.0).abs() < 0.05);
    assert_eq!(found["thrust_coefficients"].as_array().unwrap().len(), 6);
    assert!((number(&found["drag"]["k_1_m"][0]["value"]) / 0.0149 - 1.0).abs() < 0.1, "{}", found["drag"]);
    assert!((number(&found["battery"]["rate_v_s"]["value"]) * 60.0 + 1.0).abs() < 0.02, "{}", found["battery"]);
    let page = std::fs::read_to_string(folder.path().join("mine.html")).unwrap();
    assert!(page.matches("<svg").count() == 7 && !page.contains("http-equiv") && !page.contains("src="));

    let (code, _, err) = run("train --vehicle mine.toml --steps 4000 --set eval.agents=4 --set ppo.environments=64 \
         --set ppo.rollout=16 --set ppo.minibatches=2 --set budget.snapshots=1 --out run");
    assert_eq!(code, 0, "{err}");
    let (code, out, _) = run("eval run --vehicle seed_class --agents 4 --start fixed");
    assert!(code == 0 && out.contains("seed_class"), "{out}");
}

#[test]
fn a_log_that_breaks_off_or_contradicts_itself() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| racer(folder.path(), args);
    assert_eq!(run("fly --pilot --seconds 60 --out flight.mcap").0, 0);
    let whole = std::fs::read(folder.path().join("flight.mcap")).unwrap();
    std::fs::write(folder.path().join("cut.mcap"), &whole[..whole.len() * 3 / 4]).unwrap();
    let (code, out, _) = run("check cut.mcap");
    assert!(code == 3 && out.contains("PROBLEM"), "{out}");
    let (code, _, err) = run("identify cut.mcap --out cut.toml");
    assert!(code == 3 && folder.path().join("cut.toml").is_file(), "{err}");

    // The pitch setpoint with the wrong sign, by a mapping that says so.
    let mapping = include_str!("../../configs/mappings/canonical.toml").replace("\"body_rate.y\"", "\"-body_rate.y\"");
    std::fs::write(folder.path().join("wrong.toml"), mapping).unwrap();
    let (code, _, err) = run("identify flight.mcap --mapping wrong.toml --out wrong_vehicle.toml");
    assert!(code == 2 && err.contains("pitch rate goes against its setpoint"), "{err}");
    assert!(!folder.path().join("wrong_vehicle.toml").exists());
    let (code, _, err) = run("identify flight.mcap flight.mcap --out cut.toml");
    assert!(code == 2 && err.contains("nothing existing is overwritten"), "{err}");
}
