//! `racer extend`: sizes by the names of the equation and by those that `racer diagnose` prints.

use crate::support::{self, Ran};
use std::path::Path;

fn racer(folder: &Path, args: &str) -> Ran {
    support::racer(folder, &args.split(' ').collect::<Vec<_>>())
}

#[test]
fn what_a_diagnosis_prints_can_be_given() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| racer(folder.path(), args);
    let size = |file: &str| {
        let text = std::fs::read_to_string(folder.path().join(file)).unwrap();
        let table: toml::Table = text.parse().unwrap();
        table["effects"]["sizes"]["rate_second_order"]["T2"].as_float().unwrap()
    };
    for (name, asked) in [("own.toml", "T2=0.0011111111111111111"), ("read.toml", "wn=30")] {
        let ran = run(&format!("extend seed_class rate_second_order.{asked} --out {name}"));
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert!((size(name) * 900.0 - 1.0).abs() < 1e-9, "{}", size(name));
    }
    // The damping is the vehicle's time constant over that of the oscillation.
    let ran = run("extend seed_class rate_second_order.zeta=0.3 --out damped.toml");
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!((0.5 * 6.7e-3 / size("damped.toml").sqrt() - 0.3).abs() < 1e-6, "{}", size("damped.toml"));

    for (asked, said) in [
        ("rate_second_order.wn=5", "wn of 22.4 to"),
        ("rate_second_order.w=30", "T2 of 0 to 0.002 s2, or wn of"),
        ("rate_second_order.wn=30 rate_second_order.T2=0.001", "a second time"),
        ("thrust_asymmetric_lag.tau_up=0.02", "difference of"),
        ("no_effect.k=1", "an effect of the simulator"),
    ] {
        let ran = run(&format!("extend seed_class {asked} --out no.toml"));
        assert!(ran.code == 2 && ran.err.contains(said) && ran.err.contains("to do"), "{asked}: {}", ran.err);
    }
    assert!(!folder.path().join("no.toml").exists());
}

#[test]
fn the_list_has_every_name_and_its_range() {
    let folder = tempfile::tempdir().unwrap();
    let list = racer(folder.path(), "extend").out;
    let line = |key: &str| list.lines().find(|line| line.contains(key)).unwrap_or_else(|| panic!("{key}: {list}"));
    assert!(line("rate_second_order.T2").contains("0.000044 to 0.00028"), "{list}");
    assert!(line("rate_second_order.wn").contains("59.8 to 151"), "{list}");
    assert!(line("rate_slew_limit.slew").contains("0.00167 to 0.01"), "{list}");
    assert!(line("rate_second_order.zeta").contains("the vehicle's"), "{list}");
    assert!(!list.contains("0.000 to"), "{list}");
}
