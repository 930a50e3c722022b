//! How the policies on the way did: `snapshots.json`, a line each, and `evaluation.json`, the line of the best.

use crate::check::BadInput;
use crate::eval::Report;
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
    #[serde(flatten)]
    pub report: Report,
}

/// The evaluations of the run in `folder`, in the order of training.
pub fn read(folder: &Path) -> Result<Vec<Evaluated>, BadInput> {
    let path = folder.join(EVALUATED);
    let expected = "the evaluations that `racer train` writes at its end";
    let bytes = std::fs::read(&path).map_err(|error| BadInput::new(path.display(), error, expected, ""))?;
    serde_json::from_slice(&bytes).map_err(|error| BadInput::new(path.display(), error, expected, ""))
}
