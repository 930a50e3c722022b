//! How the policies on the way did: `snapshots.json`, a line each, and `evaluation.json`, the line of the best.

use crate::base::check::BadInput;
use crate::race::eval::{Report, choose};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name of the file, in a run folder.
pub const EVALUATED: &str = "snapshots.json";

/// A snapshot's evaluation.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Evaluated {
    /// File of the policy, in the run folder.
    pub snapshot: String,
    /// Environment steps and seconds of training before it was taken.
    pub steps: u64,
    pub seconds: f64,
    /// Share of the penalties at that time ([`crate::learn::ppo::PpoConfig::penalty`]).
    #[serde(default = "whole")]
    pub penalty: f64,
    #[serde(flatten)]
    pub report: Report,
}

fn whole() -> f64 {
    1.0
}

/// Those that count: while the penalties still grow, a policy is not yet what was asked for. The last one, where they
/// never were whole.
pub fn counting(all: &[Evaluated]) -> &[Evaluated] {
    let first = all.iter().position(|e| e.penalty >= 1.0).unwrap_or(all.len().saturating_sub(1));
    &all[first..]
}

/// The best of those that count.
pub fn best(all: &[Evaluated]) -> Option<&Evaluated> {
    let counting = counting(all);
    let reports: Vec<_> = counting.iter().map(|e| e.report.clone()).collect();
    choose::best(&reports).map(|place| &counting[place])
}

/// The evaluations of the run in `folder`, in the order of training.
pub fn read(folder: &Path) -> Result<Vec<Evaluated>, BadInput> {
    let path = folder.join(EVALUATED);
    let expected = "the evaluations that `racer train` writes at its end";
    let bytes = std::fs::read(&path).map_err(|error| BadInput::new(path.display(), error, expected, ""))?;
    serde_json::from_slice(&bytes).map_err(|error| BadInput::new(path.display(), error, expected, ""))
}
