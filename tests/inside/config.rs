//! Bad configurations are refused before any work, with file, line, key and what to do.

use racer::race::config::{Config, Setting, Setup};
use std::path::PathBuf;
use tempfile::TempDir;

/// A configuration file of this text; lives as long as the folder.
fn file(text: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

fn load(text: &str) -> Result<Config, racer::base::check::BadInput> {
    let (_folder, path) = file(text);
    Config::load(path.to_str().unwrap(), &[])
}

/// The message for `text` must hold every one of `parts`.
fn refuses(text: &str, parts: &[&str]) {
    let message = load(text).unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in:\n{message}");
    }
}

fn set(settings: &[&str]) -> Result<Config, racer::base::check::BadInput> {
    let settings: Result<Vec<_>, _> = settings.iter().map(|text| Setting::parse(text)).collect();
    Config::load("a2rl", &settings?)
}

#[test]
fn the_built_in_configuration_is_sound() {
    let config = Setup::load("a2rl.toml", &[]).unwrap().config;
    assert_eq!(Config::load("a2rl", &[]).unwrap(), config);
}

#[test]
fn the_resolved_configuration_reads_back_as_itself() {
    for settings in [&["ppo.learning_rate=3e-4"][..], &["budget.steps=1000000", "track=square"]] {
        let config = set(settings).unwrap();
        assert_eq!(load(&config.to_toml()).unwrap(), config);
    }
}

#[test]
fn a_file_needs_only_what_differs() {
    let config = load("[ppo]\ngamma = 0.99\n").unwrap();
    assert_eq!(config.ppo.gamma, 0.99);
    assert_eq!(config.ppo.lambda, Config::load("a2rl", &[]).unwrap().ppo.lambda);
}

#[test]
fn the_budget_set_last_counts() {
    assert_eq!(load("[budget]\nsteps = 1000\n").unwrap().budget.minutes, None);
    let config = set(&["budget.steps=1000", "budget.minutes=2"]).unwrap();
    assert_eq!((config.budget.minutes, config.budget.steps), (Some(2.0), None));
    refuses("[budget]\nsteps = 1000\nminutes = 1\n", &["mine.toml:2", "budget.steps", "remove one"]);
}

#[test]
fn unknown_keys_name_the_nearest() {
    refuses("seed = 3\n[ppo]\nlerning_rate = 1e-3\n", &["mine.toml:3", "ppo.lerning_rate", "`ppo.learning_rate`"]);
    let message = set(&["learning_rate=1e-3"]).unwrap_err().to_string();
    assert!(message.contains("--set learning_rate=1e-3") && message.contains("`ppo.learning_rate`"), "{message}");
}

#[test]
fn wrong_types_name_both_sides() {
    refuses("[ppo]\ngamma = \"high\"\n", &["mine.toml:2", "ppo.gamma", "a number", "\"high\""]);
    refuses("[env.reset]\nspeed_m_s = [1.0]\n", &["mine.toml:2", "env.reset.speed_m_s"]);
    refuses("ppo = 3\n", &["mine.toml:1", "ppo", "`3`", "a table"]);
    refuses("seed = -1\n", &["mine.toml:1", "seed", "`-1`", "zero or more"]);
}

#[test]
fn values_out_of_range_name_line_and_range() {
    refuses("[ppo]\nclip = 0.2\ngamma = 1.5\n", &["mine.toml:3", "ppo.gamma", "0 to 1", "1.5"]);
    refuses("[env.noise]\nposition_m = -1\n", &["mine.toml:2", "env.noise.position_m", "zero or more"]);
    refuses("[env.reset]\nspeed_m_s = [9, 1]\n", &["mine.toml:2", "low <= high", "[9, 1]"]);
    refuses("[budget]\nminutes = nan\n", &["mine.toml:2", "budget.minutes", "NaN"]);
}

#[test]
fn batches_that_do_not_divide_name_the_nearest_that_do() {
    refuses("[ppo]\nenvironments = 100\n", &["mine.toml:2", "multiple of 64", "64 and 128"]);
    refuses("[ppo]\nenvironments = 7\n", &["use 64"]);
    refuses("[ppo]\nminibatches = 15\n", &["mine.toml:2", "ppo.minibatches", "32768 samples", "8 and 16"]);
    // The key at fault is not in the file: the built-in configuration is named.
    refuses("[ppo]\nenvironments = 64\nrollout = 3\n", &["ppo.minibatches", "a2rl.toml (built in)", "3"]);
    refuses("[ppo]\nrollout = 4611686018427387904\n", &["ppo.rollout"]);
    refuses("[ppo]\nminibatches = 9223372036854775807\n", &["ppo.minibatches", "512"]);
}

#[test]
fn settings_that_cannot_be_are_named_as_given() {
    let message = set(&["ppo.epochs=0"]).unwrap_err().to_string();
    assert!(message.starts_with("--set ppo.epochs=0"), "{message}");
    assert!(set(&["ppo=3"]).is_err());
    assert!(set(&["ppo.gamma.deeper=3"]).is_err());
}

#[test]
fn files_that_are_not_there_or_not_toml() {
    let message = Config::load("a2rrl", &[]).unwrap_err().to_string();
    assert!(message.contains("`a2rl`") && message.contains("configs/"), "{message}");
    refuses("seed = 3\nseed 4\n", &["mine.toml:2", "seed 4", "TOML"]);
    assert!(Config::load("/", &[]).is_err());
}

#[test]
fn what_does_not_fit_the_track_or_vehicle_is_refused() {
    let refuses = |setting: &str, part: &str| {
        let message = Setup::load("a2rl", &[Setting::parse(setting).unwrap()]).unwrap_err().to_string();
        assert!(message.starts_with(&format!("--set {setting}")) && message.contains(part), "{message}");
    };
    refuses("env.gate_radius_m=0.8", "at most 0.75 m, the narrowest gate of a2rl_s2");
    refuses("env.randomize.charge=[0.1, 1.2]", "at most 1, a full battery");
    let message = Setup::load("a2rl", &[Setting::parse("track=monza").unwrap()]).unwrap_err().to_string();
    assert!(message.contains("track `monza`") && message.contains("uzh_split_s"), "{message}");
}
