//! Studies: a grid of settings times seeds, each run under the same budget, and what can be said about the settings
//! then.
//!
//! A study's folder:
//!
//! | file | what it holds |
//! |---|---|
//! | `study.toml` | the study as it was given |
//! | `plan.json` | all settings and runs that it resolved to |
//! | `runs/RUN/` | a finished run, as `racer train` leaves it, with its `result.json`; appears all at once |
//! | `runs.csv`, `timing.csv` | a line each finished run: what it reached; on what clock |
//! | `settings.csv`, `axes.csv` | the same over the seeds of a setting, and over all runs with a value of an axis |
//! | `ranking.csv` | the settings in order, with what their seeds leave open |
//! | `results.json` | all of these tables, and their methods in words |
//!
//! With a budget of steps all but `timing.csv` repeat byte for byte, however often the study was interrupted.

pub mod axes;
pub mod bands;
pub mod curves;
pub mod file;
pub mod folder;
pub mod metric;
pub mod names;
pub mod plan;
pub mod ranking;
pub mod result;
pub mod results;
pub mod shard;
pub mod summary;
pub mod tables;

pub use file::Study;
