//! A training that is stopped, or whose numbers are no numbers, and how it goes on.

use racer::base::check::BadInput;
use racer::base::error::{Error, Result};
use racer::learn::ppo::train::Iteration;
use racer::present::run::checkpoints::CHECKPOINTS;
use racer::present::run::metrics::{self, LogRow, METRICS};
use racer::present::run::{DIVERGED, POLICY, Run, SNAPSHOTS};
use racer::present::train::{Ended, TrainingWatch, make, resume};
use racer::race::config::{Setting, Setup};
use racer::race::env::tally::RaceTally;
use racer::race::snapshot::Snapshot;
use std::path::{Path, PathBuf};

/// Ten iterations of 4096 steps.
const SMALL: [&str; 8] = [
    "track=square",
    "budget.steps=40000",
    "budget.snapshots=5",
    "ppo.environments=256",
    "ppo.rollout=16",
    "ppo.minibatches=4",
    "ppo.average=0.9",
    "eval.agents=8",
];

/// Ends a training after so many iterations, if not 0, and hears what is remarked.
#[derive(Default)]
struct Watch {
    stop_after: usize,
    done: usize,
    remarks: Vec<String>,
}

impl TrainingWatch for Watch {
    fn iteration(&mut self, _: &Iteration<RaceTally>, _: &LogRow) {
        self.done += 1;
    }
    fn remark(&mut self, text: &str) {
        self.remarks.push(text.into());
    }
    fn stop(&self) -> bool {
        self.done == self.stop_after
    }
}

fn setup(more: &[&str]) -> Setup {
    let settings: Vec<_> = SMALL.iter().chain(more).map(|s| Setting::parse(s).unwrap()).collect();
    Setup::load("a2rl", &settings).unwrap()
}

/// Trains in the new folder `name`, until so many iterations are done.
fn train(at: &Path, name: &str, more: &[&str], stop_after: usize, watch: &mut Watch) -> (PathBuf, Result<Ended>) {
    train_as(at, name, &setup(more), stop_after, watch)
}

fn train_as(at: &Path, name: &str, setup: &Setup, stop_after: usize, watch: &mut Watch) -> (PathBuf, Result<Ended>) {
    let folder = at.join(name);
    let run = Run::create(Some(&folder), name).unwrap();
    watch.stop_after = if stop_after == 0 { usize::MAX } else { stop_after };
    (folder, make(&run, setup, 2, "test", watch))
}

/// Everything that a training decides: policies as files, and of the log what is no clock.
fn decided(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let files = std::fs::read_dir(folder.join(SNAPSHOTS)).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = files.chain([folder.join(POLICY)]).collect();
    files.sort();
    let of = |path: &PathBuf| (path.file_name().unwrap().to_str().unwrap().to_string(), std::fs::read(path).unwrap());
    let mut all: Vec<_> = files.iter().map(of).collect();
    let names = ["steps", "episode/return_median", "ppo/loss", "ppo/gradient_norm", "ppo/learning_rate"];
    let rows = metrics::read(&folder.join(METRICS), names).unwrap();
    all.push((METRICS.into(), format!("{rows:?}").into_bytes()));
    all
}

fn resumed(folder: &Path) -> (Result<Option<Ended>>, Vec<String>) {
    let mut watch = Watch { stop_after: usize::MAX, ..Watch::default() };
    let ended = resume(folder, 1, &mut watch);
    (ended, watch.remarks)
}

#[test]
fn what_goes_on_is_what_never_stopped() {
    let at = tempfile::tempdir().unwrap();
    let (whole, ended) = train(at.path(), "whole", &[], 0, &mut Watch::default());
    assert!(matches!(ended.unwrap(), Ended::Finished(_)));
    let expected = decided(&whole);
    assert_eq!(expected.len(), 7);
    assert!(!whole.join(CHECKPOINTS).exists(), "a finished run needs none");

    // Between two snapshots; after one; before the first.
    for (stop_after, name) in [(5, "between"), (8, "after"), (1, "before")] {
        let (folder, ended) = train(at.path(), name, &[], stop_after, &mut Watch::default());
        assert!(matches!(ended.unwrap(), Ended::Stopped { .. }), "{name}");
        assert!(!folder.join(POLICY).exists());
        let (ended, remarks) = resumed(&folder);
        assert!(matches!(ended.unwrap(), Some(Ended::Finished(_))), "{name}");
        assert!(remarks.iter().any(|r| r.starts_with("going on")), "{remarks:?}");
        assert!(decided(&folder) == expected, "{name}");
    }
    assert!(resumed(&whole).0.unwrap().is_none(), "finished is finished");
}

/// Effects that remember: commands on their way, a filter's slope, a battery's polarisation.
#[test]
fn a_vehicle_with_effects_goes_on_with_what_it_remembers() {
    let at = tempfile::tempdir().unwrap();
    let mut setup = setup(&[]);
    setup.vehicle.effects.sizes.insert("rate_delay".into(), [("delay".to_string(), 0.025)].into());
    let (whole, ended) = train_as(at.path(), "whole", &setup, 0, &mut Watch::default());
    assert!(matches!(ended.unwrap(), Ended::Finished(_)));
    let (stopped, _) = train_as(at.path(), "stopped", &setup, 5, &mut Watch::default());
    assert!(matches!(resumed(&stopped).0.unwrap(), Some(Ended::Finished(_))));
    assert!(decided(&stopped) == decided(&whole));
}

#[test]
fn a_damaged_checkpoint_falls_back_to_the_one_before_and_says_so() {
    let at = tempfile::tempdir().unwrap();
    let (whole, _) = train(at.path(), "whole", &[], 0, &mut Watch::default());
    for (name, damage) in [("cut", 1), ("bit", 2), ("log", 3), ("policy", 4)] {
        let (folder, _) = train(at.path(), name, &[], 7, &mut Watch::default());
        let mut all: Vec<_> = std::fs::read_dir(folder.join(CHECKPOINTS)).unwrap().map(|e| e.unwrap().path()).collect();
        all.retain(|path| path.extension().is_some());
        all.sort();
        assert_eq!(all.len(), 2, "{all:?}");
        let last = all.last().unwrap();
        let mut bytes = std::fs::read(last).unwrap();
        let middle = bytes.len() / 2;
        match damage {
            1 => bytes.truncate(middle),
            2 => bytes[middle] ^= 1,
            3 => {
                // As if the last rows had not reached the disk.
                let log = std::fs::read_to_string(folder.join(METRICS)).unwrap();
                let kept: Vec<_> = log.lines().take(7).collect();
                std::fs::write(folder.join(METRICS), kept.join("\n") + "\n").unwrap();
            }
            _ => {
                let mut taken: Vec<_> = std::fs::read_dir(folder.join(SNAPSHOTS)).unwrap().flatten().collect();
                taken.sort_by_key(|entry| entry.path());
                // The last of all was taken because it was stopped, and counts in no checkpoint.
                taken[..taken.len() - 1].iter().rev().take(1).for_each(|e| std::fs::remove_file(e.path()).unwrap());
            }
        }
        std::fs::write(last, bytes).unwrap();
        let (ended, remarks) = resumed(&folder);
        assert!(matches!(ended.unwrap(), Some(Ended::Finished(_))), "{name}");
        let said = remarks.iter().any(|r| r.contains("is not used") && r.contains(".checkpoint"));
        assert!(said, "{name}: {remarks:?}");
        assert!(decided(&folder) == decided(&whole), "{name}");
    }
}

#[test]
fn what_is_no_run_or_another_one_is_refused() {
    let at = tempfile::tempdir().unwrap();
    let refused = |folder: &Path| match resumed(folder).0.unwrap_err() {
        Error::BadInput(BadInput { found, .. }) => found,
        other => panic!("{other}"),
    };
    assert!(refused(at.path()).contains("config.toml"));
    let (folder, _) = train(at.path(), "a", &[], 5, &mut Watch::default());
    // A checkpoint of another configuration is none of this one: it is trained from the beginning, and said.
    let text = std::fs::read_to_string(folder.join("config.toml")).unwrap();
    std::fs::write(folder.join("config.toml"), text.replace("seed = 1", "seed = 2")).unwrap();
    let (ended, remarks) = resumed(&folder);
    assert!(matches!(ended.unwrap(), Some(Ended::Finished(_))));
    let all = remarks.join("\n");
    assert!(all.contains("another configuration") && all.contains("from the beginning"), "{all}");
    let (other, _) = train(at.path(), "b", &["seed=2"], 0, &mut Watch::default());
    assert!(decided(&folder) == decided(&other));
}

#[test]
fn numbers_that_are_none_end_a_training_after_three_setbacks() {
    let at = tempfile::tempdir().unwrap();
    let mut watch = Watch::default();
    let (folder, ended) = train(at.path(), "a", &["ppo.value_coefficient=1e38"], 0, &mut watch);
    let text = ended.unwrap_err().to_string();
    for part in ["diverges", "was not finite", "ppo.learning_rate", "ppo.value_coefficient"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(watch.remarks.len(), 4, "{:?}", watch.remarks);
    assert!(folder.join(DIVERGED).is_file() && !folder.join(POLICY).exists());
    let kept: Vec<_> = std::fs::read_dir(folder.join(SNAPSHOTS)).unwrap().map(|e| e.unwrap().path()).collect();
    assert_eq!(kept.len(), 1);
    let policy = Snapshot::read(&kept[0]).unwrap();
    assert!(policy.network.parameters.iter().all(|x| x.is_finite()));
}

/// A rate at which it diverges, and a tenth of which it does not.
#[test]
fn a_training_that_diverges_goes_back_and_on_with_a_lower_rate() {
    let at = tempfile::tempdir().unwrap();
    let mut watch = Watch::default();
    let rates = ["ppo.learning_rate=10", "ppo.learning_rate_final=1e-4"];
    let (folder, ended) = train(at.path(), "a", &rates, 0, &mut watch);
    assert!(matches!(ended.unwrap(), Ended::Finished(_)));
    assert!((1..=3).contains(&watch.remarks.len()) && watch.remarks[0].contains("at 0.100 of"), "{:?}", watch.remarks);
    Snapshot::read(&folder.join(POLICY)).unwrap();
    let rows = metrics::read(&folder.join(METRICS), ["steps", "ppo/learning_rate", "ppo/loss"]).unwrap();
    assert_eq!(rows.len(), 10, "rows that were taken back are not in the log");
    assert!(rows.iter().all(|row| row[1].unwrap() <= 1.0 && row[2].is_some()), "{rows:?}");
    let told = std::fs::read_to_string(folder.join(DIVERGED)).unwrap();
    assert!(told.contains("a weight was not finite"), "{told}");
}

#[test]
fn a_policy_of_no_numbers_has_no_file() {
    let setup = setup(&[]);
    let mut network = racer::learn::nn::Network::<f32>::zeros(racer::race::env::observe::OBSERVATIONS);
    network.parameters[70] = f32::NAN;
    let taken = racer::learn::ppo::train::NetworkSnapshot { network, steps: 1, seconds: 1.0 };
    assert!(racer::race::train::policy_of(&setup, &taken).checked_bytes().is_err());
}
