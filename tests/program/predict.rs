//! A vehicle held against a flight, as users do it.

use crate::support::{self, Ran};
use serde_json::Value;
use std::path::Path;

fn racer(folder: &Path, args: &str) -> Ran {
    support::racer(folder, &args.split_whitespace().collect::<Vec<_>>())
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

#[test]
fn a_prediction_and_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| racer(folder.path(), args);
    assert_eq!(run("fly --pilot --seconds 80 --out flight.mcap").code, 0);
    let ran = run("identify flight.mcap --out mine.toml --validated part.toml --json mine.json");
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.out.contains("hovers at") && ran.out.contains("full throttle"), "{}", ran.out);
    let text = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    assert!(text.contains("\"option\"") || text.contains("\"record of the log\""), "{text}");
    assert!(text.contains("thrust_from = \"collective command\"") && text.contains("thrust_n = \"log\""), "{text}");

    // The figures of the identification, digit for digit.
    let found = json(&std::fs::read_to_string(folder.path().join("mine.json")).unwrap());
    let ran = run("predict flight.mcap --vehicle part.toml --part validation --json");
    let predicted = json(&ran.out);
    for (axis, name) in [("roll", "roll rate"), ("yaw", "yaw rate"), ("thrust", "specific force z")] {
        let channels = predicted["channels"].as_array().unwrap();
        let channel = channels.iter().find(|c| c["name"] == name).unwrap();
        for key in ["rmse", "mae", "r2"] {
            assert_eq!(channel["scores"][0][key].to_string(), found["response"][axis][key].to_string(), "{name} {key}");
        }
        assert_eq!(channel["scores"][0]["n"], found["response"][axis]["n_validation"]);
    }

    // Two vehicles on the same samples; the file's residuals are the table's.
    let ran = run("predict flight.mcap --vehicle mine.toml --vehicle seed_class --out both.csv");
    assert!(ran.code == 0 && ran.out.contains("open loop") && ran.out.contains("seed_class"), "{}{}", ran.out, ran.err);
    let mut reader = csv::Reader::from_path(folder.path().join("both.csv")).unwrap();
    let header: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    let expected = "log,time_s,channel,unit,measured,predicted,residual,predicted_2,residual_2";
    assert_eq!(header.join(","), expected);
    std::fs::copy("configs/vehicles/seed_class.toml", folder.path().join("other.toml")).unwrap();
    assert!(ran.out.contains("change of RMS") && ran.out.contains(" to +"), "{}", ran.out);
    let one_name = json(&run("predict flight.mcap --vehicle seed_class --vehicle other.toml --json").out);
    assert_eq!(one_name["vehicles"], serde_json::json!(["seed_class", "other.toml"]));
    let ran = run("predict flight.mcap --vehicle seed_class --vehicle mine.toml --json");
    let channel = json(&ran.out)["channels"][0].clone();
    let [by, low, high] = ["by", "low", "high"].map(|key| channel["change"][0][key].as_f64().unwrap());
    let [first, second] = [0, 1].map(|k| channel["scores"][k]["rmse"].as_f64().unwrap());
    assert!((1.0 + by - second / first).abs() < 1e-9 && low < by && by < high && high < 0.0, "{low} {by} {high}");
    let (mut squares, mut n) = (0.0, 0.0);
    for row in reader.records().map(Result::unwrap).filter(|row| &row[2] == "roll rate") {
        let number = |k: usize| row[k].parse::<f64>().unwrap();
        assert!((number(4) - number(5) - number(6)).abs() < 1e-9);
        squares += number(6) * number(6);
        n += 1.0;
    }
    let all = json(&run("predict flight.mcap --vehicle mine.toml --json").out);
    let rmse = all["channels"][0]["scores"][0]["rmse"].as_f64().unwrap();
    assert!(((squares / n).sqrt() / rmse - 1.0).abs() < 1e-9 && rmse > 0.0, "{rmse}");
    let ran = run("predict flight.mcap --vehicle mine.toml --part training --out signals.mcap");
    assert_eq!(ran.code, 0, "{}", ran.err);
    let bytes = std::fs::read(folder.path().join("signals.mcap")).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let topics: Vec<&str> = summary.channels.values().map(|channel| channel.topic.as_str()).collect();
    assert!(["/roll_rate", "/specific_force_z", "/voltage"].iter().all(|t| topics.contains(t)), "{topics:?}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| racer(folder.path(), args);
    assert_eq!(run("fly --pilot --seconds 40 --out flight.mcap").code, 0);
    for (args, said) in [
        ("predict flight.mcap", "--vehicle"),
        ("predict flight.mcap --vehicle nowhere.toml", "nowhere.toml"),
        ("predict flight.mcap --vehicle seed_class --out signals.txt", ".csv or .mcap"),
        ("predict flight.mcap --vehicle seed_class --out flight.mcap", "nothing existing is overwritten"),
        ("predict flight.mcap --vehicle seed_class --part some", "validation"),
        ("predict flight.mcap --vehicle seed_class --rate-cutoff -3", "--rate-cutoff"),
        ("predict none.mcap --vehicle seed_class", "none.mcap"),
    ] {
        let ran = run(args);
        assert!(ran.code == 2 && ran.err.contains(said), "{args}: {} {}", ran.code, ran.err);
    }
}

#[test]
fn a_flight_without_rates_makes_no_vehicle_unless_asked() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| racer(folder.path(), args);
    assert_eq!(run("fly --pilot --seconds 60 --out flight.mcap").code, 0);
    let canonical = include_str!("../../configs/mappings/canonical.toml");
    let without: String =
        canonical.lines().filter(|line| !line.starts_with("rate =")).map(|line| format!("{line}\n")).collect();
    assert_ne!(without.trim(), canonical.trim());
    std::fs::write(folder.path().join("still.toml"), without).unwrap();
    let ran = run("identify flight.mcap --mapping still.toml --out mine.toml");
    assert!(ran.code == 2 && ran.err.contains("no rates") && ran.err.contains("--partial"), "{}", ran.err);
    assert!(!folder.path().join("mine.toml").exists());
    let ran = run("identify flight.mcap --mapping still.toml --out mine.toml --partial");
    assert_eq!(ran.code, 0, "{}", ran.err);
    let text = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    assert!(text.contains("no rate setpoint in the log"), "{text}");
}
