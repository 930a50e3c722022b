//! What racer wrote at commit 73e7003 still opens, and means what it meant: a policy of
//! `racer train --config a2rl --track square --steps 4000000 --set eval.agents=64 --set budget.snapshots=2 --seed 2`.

use racer::base::lane::Level;
use racer::race::config::{Config, Setting};
use racer::race::env::Race;
use racer::race::env::reset::StartPlace;
use racer::race::eval::score::Benchmark;
use racer::race::eval::{EvalConfig, benchmark};
use racer::race::snapshot::Snapshot;
use std::path::Path;

const CONFIG: &str = "tests/golden/config-73e7003.toml";

fn config(name: &str, settings: &[&str]) -> Config {
    let settings: Vec<_> = settings.iter().map(|s| Setting::parse(s).unwrap()).collect();
    Config::load(name, &settings).unwrap()
}

fn raced(agents: usize) -> Benchmark {
    let Snapshot { network, about } = Snapshot::read(Path::new("tests/golden/policy-73e7003.safetensors")).unwrap();
    assert_eq!((about.track.name.as_str(), about.steps, about.seed), ("square", 4_030_464, 2));
    assert_eq!(about.env, config(CONFIG, &[]).env);
    let race = Race::new(&about.env, &about.track, &about.vehicle, about.seed);
    let config = EvalConfig { agents, ..about.eval };
    benchmark(Level::best(), &race, &about.track, &network, StartPlace::Pad, &config).0
}

/// What `racer eval --start fixed --agents 1` said at 73e7003: the nominal vehicle, no random number in its flight.
#[test]
fn a_policy_flies_the_lap_that_it_flew() {
    let found = raced(1);
    let lap = found.lap_time_s.expect("a lap").median;
    assert!((lap - 1.784_142).abs() < 2e-4, "{lap} s");
    assert!((found.top_speed_m_s - 9.820_558).abs() < 2e-3, "{} m/s", found.top_speed_m_s);
    assert!((found.mean_action_change_sq - 0.014_895).abs() < 2e-5, "{}", found.mean_action_change_sq);
    assert_eq!(found.gates_passed.mean, 5.0);
}

/// With 200 agents it said 100 %, 1.837 s, and 1.649 to 2.145 s; which vehicles are drawn has changed since.
#[test]
fn a_policy_flies_other_vehicles_as_well_as_it_did() {
    let found = raced(200);
    let laps = found.lap_time_s.expect("laps");
    assert_eq!(found.lap_completion, 1.0);
    // The laps spread by 0.15 s, so that a median of 200 is good to 0.013 s.
    assert!((laps.median - 1.837).abs() < 0.05, "{} s", laps.median);
    assert!((laps.p05 - 1.649).abs() < 0.06 && (laps.p95 - 2.145).abs() < 0.1, "{} to {} s", laps.p05, laps.p95);
}

#[test]
fn the_configuration_of_a_run_says_what_it_said() {
    let said = ["track=square", "budget.steps=4000000", "seed=2", "eval.agents=64", "budget.snapshots=2"];
    // Its entropy was that of the Gaussian before the tanh, without a key to say so, and the default another weight.
    let entropy = ["ppo.entropy=3e-3", "ppo.entropy_squashed=false", "ppo.entropy_end=1.0"];
    // It looked further ahead, its step size knew the share of the budget alone, nothing pulled commands off the stops,
    // the weights were kept as the last iteration left them, fewer episodes started on the pad, what failed was not
    // tried again, and apertures were the same from the first step on.
    let later = ["ppo.gamma=0.995", "ppo.refine_after=0.0", "ppo.saturation=0.0", "ppo.average=0.0"];
    let starts = [
        "env.reset.pad_share=0.15",
        "env.reset.retry_share=0.0",
        "env.gate_radius_begin=1.0",
        "env.gate_radius_full=0.0",
    ];
    let now = config("a2rl", &[&said[..], &entropy, &later, &starts].concat());
    assert_eq!(config(CONFIG, &[]), now);
    assert!(!config(CONFIG, &[]).ppo.entropy_squashed);
}

/// Runs from before penalties could grow do not have the keys for it.
#[test]
fn a_key_that_a_run_lacks_has_its_old_meaning_and_in_other_files_is_built_in() {
    let whole = std::fs::read_to_string(CONFIG).unwrap();
    let lines: Vec<&str> = whole.lines().filter(|line| !line.starts_with("penalty_")).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.toml");
    let name = path.to_str().unwrap();
    std::fs::write(&path, lines.join("\n")).unwrap();
    let older = config(name, &[]);
    assert_eq!((older.ppo.penalty_begin, older.ppo.penalty_full), (1.0, 0.0));
    assert_eq!(config(name, &["ppo.penalty_full=0.25"]).ppo.penalty_full, 0.25);

    let partial: Vec<&str> = lines.into_iter().filter(|line| !line.starts_with("clip")).collect();
    std::fs::write(&path, partial.join("\n")).unwrap();
    assert_eq!(config(name, &[]).ppo.penalty_full, config("a2rl", &[]).ppo.penalty_full);
}
