//! The four examples: they run as written, use what users can use, and say what the README says they do.

use std::path::Path;
use std::process::Command;

/// What an example prints.
fn example(name: &str) -> String {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--example", name]).current_dir(env!("CARGO_MANIFEST_DIR"));
    if !cfg!(debug_assertions) {
        cargo.arg("--release");
    }
    let output = cargo.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The number in `text` that follows `before` or, without it, that precedes `after`.
fn number(text: &str, before: &str, after: &str) -> f64 {
    let part = &text[text.find(before).unwrap_or_else(|| panic!("no `{before}` in {text}")) + before.len()..];
    let part = part[..part.find(after).unwrap_or_else(|| panic!("no `{after}` in {part}"))].trim();
    part.rsplit(' ').next().unwrap().parse().unwrap_or_else(|_| panic!("no number: {part}"))
}

#[test]
fn simulate_passes_gates() {
    let text = example("simulate");
    assert!(text.contains("1000 vehicles"), "{text}");
    assert!(number(&text, ":", " gates passed") > 1000.0, "a gate or more each: {text}");
}

#[test]
fn train_learns_and_keeps_what_it_learned() {
    let text = example("train");
    let gates: Vec<f64> =
        text.lines().filter(|line| line.contains("an episode")).map(|line| number(line, "steps:", " gates")).collect();
    assert!(gates.len() >= 4 && gates[gates.len() - 1] > 2.0 * gates[0], "{text}");
    assert!(text.contains("it flies the same: true"), "{text}");
}

#[test]
fn identify_finds_the_vehicle_that_flew() {
    let text = example("identify");
    let line = text.lines().find(|line| line.starts_with("thrust over weight")).expect("the ratio");
    let (truth, found) = (number(line, ":", " in truth"), number(line, "truth,", " in the new"));
    assert!((found / truth - 1.0).abs() < 0.05, "{line}");
    let line = text.lines().find(|line| line.starts_with("roll lag, ms")).expect("the lag");
    let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!((numbers[1] / numbers[0] - 1.0).abs() < 0.1, "{line}");
}

#[test]
fn diagnose_names_the_effect_that_was_flown() {
    let text = example("diagnose");
    assert!(text.contains("Named") && text.contains("(axial_inflow)"), "{text}");
    let size = number(&text, " k = ", " (");
    assert!((size / 0.6 - 1.0).abs() < 0.25, "{text}");
    assert!(text.lines().last().is_some_and(|line| line.contains("axial_inflow")), "{text}");
}

/// Within this repository the floors are open to tests, and so to examples; elsewhere they are not.
#[test]
fn examples_are_short_and_use_the_facade_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.lines().count() < 60, "{} is long", path.display());
        for floor in ["base", "model", "learn", "race", "flight", "insight", "present", "api", "cli"] {
            let names = [format!("racer::{floor}::"), format!("racer::{{{floor}::"), format!(" {floor}::")];
            assert!(names.iter().all(|name| !text.contains(name)), "{} looks into {floor}", path.display());
        }
        seen += 1;
    }
    assert_eq!(seen, 4);
}
