//! The run folder: what a training leaves behind.
//!
//! | file | what it holds |
//! |---|---|
//! | `command.txt` | the command line |
//! | `config.toml`, `track.toml`, `vehicle.toml` | what it resolved to; `--config RUN/config.toml` repeats it |
//! | `provenance.json` | version, machine, SIMD level, threads, time |
//! | `metrics.csv`, `tensorboard/` | one row an iteration, written as it comes |
//! | `snapshots/` | policies on the way, named by environment steps, each written when it is taken |
//! | `checkpoints/` | what `racer train --resume RUN` goes on from; gone from a finished run |
//! | `diverged.json` | numbers that were not finite, and what was done about them; seldom there |
//! | `snapshots.json` | how each did in evaluation |
//! | `policy.safetensors`, `evaluation.json` | the best of them, and how it did |
//! | `lap.csv`, `lap.svg` | a flight of the nominal vehicle with it: step by step, and from above |
//! | `training.svg` | learning curves |

pub mod checkpoints;
pub mod evaluated;
mod find;
pub mod health;
pub mod live;
pub mod metrics;
pub mod provenance;
pub mod resolved;
pub mod tensorboard;

pub use crate::base::fsio::free;
pub use find::{FoundPolicy, find, folder};

use crate::base::check::BadInput;
use crate::base::error::{Error, Result};
use crate::base::fsio;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Folder that run folders are made in.
pub const RUNS: &str = "runs";
/// What a run was configured with, in a run folder.
pub const CONFIG: &str = "config.toml";
/// The best policy, in a run folder.
pub const POLICY: &str = "policy.safetensors";
/// Folder of the policies on the way, in a run folder.
pub const SNAPSHOTS: &str = "snapshots";

/// How a training met numbers that are not finite, in a run folder; there is none of one that did not.
pub const DIVERGED: &str = "diverged.json";
/// Folder of the TensorBoard event file, in a run folder.
pub const TENSORBOARD: &str = "tensorboard";

/// A run folder being filled.
#[derive(Clone, Debug)]
pub struct Run {
    pub folder: PathBuf,
}

impl Run {
    /// A new folder: `out`, or one below `runs/` named by time and `name`. Fails where it cannot be written to, and
    /// where `out` already holds anything.
    pub fn create(out: Option<&Path>, name: &str) -> Result<Self, BadInput> {
        let folder = match out {
            Some(out) => out.to_path_buf(),
            None => free(&Path::new(RUNS).join(format!("{}-{}", stamp(SystemTime::now()), plain(name)))),
        };
        fsio::new_folder(&folder, "--out")?;
        fsio::new_folder(&folder.join(SNAPSHOTS), "--out")?;
        fsio::new_folder(&folder.join(TENSORBOARD), "--out")?;
        Ok(Self { folder })
    }

    /// Writes a new file of the run. Fails if it exists.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<PathBuf> {
        let path = self.folder.join(name);
        fsio::write_new(&path, bytes.as_ref()).map_err(Error::write(&path))?;
        Ok(path)
    }

    /// Writes a file of the run, in place of one that an earlier attempt at it has left.
    pub fn replace(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<PathBuf> {
        let path = self.folder.join(name);
        fsio::replace(&path, bytes.as_ref()).map_err(Error::write(&path))?;
        Ok(path)
    }
}

/// UTC in letters that suit a file name and sort by time, such as `20261121T013000Z`.
fn stamp(time: SystemTime) -> String {
    humantime::format_rfc3339_seconds(time).to_string().replace(['-', ':'], "")
}

/// A name reduced to what every file system takes.
pub fn plain(name: &str) -> String {
    let kept = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' };
    name.chars().map(kept).take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_free_and_plain() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("e.json");
        assert_eq!(free(&path), path);
        std::fs::write(&path, "").unwrap();
        assert_eq!(free(&path), folder.path().join("e-2.json"));
        assert_eq!(plain("../my track"), "---my-track");
        assert_eq!(stamp(SystemTime::UNIX_EPOCH), "19700101T000000Z");
    }

    #[test]
    fn a_folder_with_files_in_it_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let run = Run::create(Some(&out), "x").unwrap();
        run.write("a.txt", "a").unwrap();
        assert!(run.write("a.txt", "b").unwrap_err().to_string().contains("a.txt"));
        assert!(Run::create(Some(&out), "x").is_err());
    }
}
