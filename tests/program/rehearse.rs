//! `racer pilot --rehearse` with Betaflight's own simulator build, where `RACER_BETAFLIGHT` names it, and with
//! ArduCopter's, where `RACER_ARDUPILOT` does.

use crate::support::{racer, skipped};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

/// Absolute, for tests run in folders of their own.
fn golden() -> String {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    top.join("tests/golden/policy-73e7003.safetensors").display().to_string()
}

#[test]
fn what_is_no_firmware_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let policy = golden();
    let silent = folder.path().join("silent");
    std::fs::write(&silent, "#!/bin/sh\nexec sleep 60\n").unwrap();
    std::fs::set_permissions(&silent, std::fs::Permissions::from_mode(0o755)).unwrap();
    let silent = silent.display().to_string();
    for (arguments, complaint) in [
        (vec![policy.as_str(), "--rehearse", "betaflight"], "--firmware"),
        (vec![&policy, "--firmware", "x"], "--rehearse"),
        (vec!["--rehearse", "betaflight", "--firmware", "missing", "--excite", "60"], "make TARGET=SITL"),
        (vec!["--rehearse", "betaflight", "--firmware", "missing", "--excite", "6"], "--excite"),
        (vec![&policy, "--rehearse", "betaflight", "--firmware", "x", "--arm-length", "0"], "--arm-length"),
        (vec![&policy, "--rehearse", "betaflight", "--firmware", "x", "--inertia", "1,2"], "three"),
        (vec![&policy, "--rehearse", "px4", "--firmware", "x"], "betaflight, ardupilot"),
        (vec![&policy, "--rehearse", "ardupilot"], "--firmware"),
        (vec![&policy, "--rehearse", "ardupilot", "--firmware", "missing"], "./waf copter"),
        (vec![&policy, "--rehearse", "ardupilot", "--firmware", "true", "--clock", "wall"], "goes by racer's time"),
        (vec![&policy, "--rehearse", "ardupilot", "--firmware", "/bin/true"], "ends at once"),
        // What neither ends nor speaks, as another firmware's simulator does not.
        (vec![&policy, "--rehearse", "ardupilot", "--firmware", &silent], "no servo outputs within"),
    ] {
        let ran = racer(folder.path(), &[["pilot"].as_slice(), &arguments].concat());
        assert_eq!(ran.code, 2, "{arguments:?}: {}", ran.err);
        assert!(ran.err.contains(complaint), "{arguments:?}: {}", ran.err);
    }
}

#[test]
fn a_policy_laps_through_betaflight_and_the_excitation_is_identified() {
    let Some(firmware) = std::env::var("RACER_BETAFLIGHT").ok() else {
        return skipped("RACER_BETAFLIGHT, Betaflight's simulator build,", "RACER_REQUIRE_BETAFLIGHT");
    };
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| racer(folder.path(), arguments);
    let through = ["--rehearse", "betaflight", "--firmware", &firmware];
    let policy = golden();
    let flight = ["--laps", "2", "--log", "laps.mcap", "--blackbox", "laps.bfl"];
    let laps = run(&[["pilot", &policy].as_slice(), &through, &flight].concat());
    assert_eq!(laps.code, 0, "{}{}", laps.out, laps.err);
    assert!(laps.out.contains("the laps are flown"), "{}", laps.out);
    let checked = run(&["check", "laps.bfl"]);
    assert!(checked.out.contains("motors"), "{}{}", checked.out, checked.err);

    let excited = run(&[["pilot", "--excite", "100", "--log", "excited.mcap"].as_slice(), &through].concat());
    assert_eq!(excited.code, 0, "{}{}", excited.out, excited.err);
    let found = run(&["identify", "excited.mcap", "--out", "found.toml"]);
    assert_eq!(found.code, 0, "{}{}", found.out, found.err);
    assert!(found.out.contains("thrust from the motor outputs"), "{}", found.out);
}

#[test]
fn a_policy_laps_through_ardupilot_and_the_excitation_is_identified() {
    let Some(firmware) = std::env::var("RACER_ARDUPILOT").ok() else {
        return skipped("RACER_ARDUPILOT, ArduCopter's simulator build,", "RACER_REQUIRE_ARDUPILOT");
    };
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| racer(folder.path(), arguments);
    let through = ["--rehearse", "ardupilot", "--firmware", &firmware];
    let policy = golden();
    let flight = ["--laps", "2", "--log", "laps.mcap", "--blackbox", "laps.BIN"];
    let laps = run(&[["pilot", &policy].as_slice(), &through, &flight].concat());
    assert_eq!(laps.code, 0, "{}{}", laps.out, laps.err);
    assert!(laps.out.contains("the laps are flown"), "{}", laps.out);
    // The mark that its log begins with.
    let log = std::fs::read(folder.path().join("laps.BIN")).unwrap();
    assert!(log.len() > 100_000 && log.starts_with(&[0xa3, 0x95]), "{} bytes", log.len());
    assert!(run(&["check", "laps.mcap"]).out.contains("motors"));

    // The same sensors and the same time: the same flight.
    let again = run(&[["pilot", &policy].as_slice(), &through, &["--laps", "2"]].concat());
    assert_eq!(again.out, laps.out);

    let excited = run(&[["pilot", "--excite", "100", "--log", "excited.mcap"].as_slice(), &through].concat());
    assert_eq!(excited.code, 0, "{}{}", excited.out, excited.err);
    let found = run(&["identify", "excited.mcap", "--out", "found.toml"]);
    assert_eq!(found.code, 0, "{}{}", found.out, found.err);
    assert!(found.out.contains("thrust from the motor outputs"), "{}", found.out);
}
