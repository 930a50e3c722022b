//! A study's folder: what is finished, whether it is still what the study asks for, and where new runs go.

use super::plan::{Planned, StudyPlan};
use super::result::{RESULT, RunResult};
use super::results::Results;
use super::tables;
use crate::base::check::{BadInput, Check};
use crate::base::encode;
use crate::base::error::{Error, Result};
use crate::base::fsio;
use crate::present::run::{DIVERGED, POLICY, resolved};
use crate::race::config::Setup;
use crate::race::snapshot::Snapshot;
use std::path::{Path, PathBuf};

/// Name of the plan in it, by which it is known.
pub const PLAN: &str = "plan.json";
/// Name of the study's file in it.
const STUDY: &str = "study.toml";
/// Folder of the finished runs in it, and of those being made.
const RUNS: &str = "runs";
const WORK: &str = ".work";
/// Folder of damaged runs that were made again.
const ASIDE: &str = "damaged";

/// What there is of a run.
#[derive(Clone, Debug)]
pub enum RunState {
    Missing,
    Finished(Box<RunResult>),
    /// Its numbers were not finite on the way: it is not what its setting is worth.
    Diverged,
    /// Something that a training did not leave so, and why.
    Damaged(String),
}

/// Where a study is kept.
#[derive(Clone, Debug)]
pub struct Folder {
    pub path: PathBuf,
}

impl Folder {
    /// The folder at `path`, which is a study's, or is new or empty. Fails where a finished run in it was made with
    /// another configuration than `planned` now asks for. Nothing is written yet.
    pub fn open(path: &Path, planned: &Planned) -> Result<Self> {
        let folder = Self { path: path.into() };
        if !folder.path.join(PLAN).is_file() {
            let mut entries = std::fs::read_dir(path).into_iter().flatten().flatten();
            // Hidden files are another part of the study about to write the plan.
            if entries.any(|entry| !entry.file_name().to_string_lossy().starts_with('.')) || path.is_file() {
                let expected = "a study's folder, or one that is new or empty";
                return Err(
                    BadInput::new(path.display(), "something else", expected, "choose another path (--out)").into()
                );
            }
        }
        for (run, (_, setup)) in planned.plan.runs.iter().zip(&planned.runs) {
            if matches!(folder.state(&run.name), RunState::Finished(_) | RunState::Diverged) {
                same(&folder.run(&run.name), setup)?;
            }
        }
        Ok(folder)
    }

    /// Writes plan and study file, in place of those of an earlier start.
    pub fn begin(&self, plan: &StudyPlan, study: &str) -> Result<()> {
        let failed = |error| {
            BadInput::new(self.path.display(), error, "a folder that can be written to", "choose another path (--out)")
        };
        std::fs::create_dir_all(&self.path).map_err(failed)?;
        fsio::replace(&self.path.join(PLAN), encode::json("the plan", plan)?.as_bytes()).map_err(failed)?;
        fsio::replace(&self.path.join(STUDY), study.as_bytes()).map_err(failed)?;
        std::fs::create_dir_all(self.path.join(RUNS)).map_err(failed)?;
        Ok(())
    }

    /// The folder of a finished run.
    pub fn run(&self, name: &str) -> PathBuf {
        self.path.join(RUNS).join(name)
    }

    /// Where runs are made.
    pub fn work(&self) -> PathBuf {
        self.path.join(WORK)
    }

    /// Whether the run has its result.
    pub fn finished(&self, name: &str) -> bool {
        matches!(self.state(name), RunState::Finished(_))
    }

    /// What there is of the run.
    pub fn state(&self, name: &str) -> RunState {
        let folder = self.run(name);
        if !folder.exists() {
            return RunState::Missing;
        }
        let whole = || -> Result<RunState, BadInput> {
            for part in ["config.toml", "track.toml", "vehicle.toml"] {
                let path = folder.join(part);
                if std::fs::metadata(&path).map_or(0, |file| file.len()) == 0 {
                    return Err(BadInput::new(path.display(), "nothing", "what the run was trained as", ""));
                }
            }
            if folder.join(DIVERGED).is_file() {
                return Ok(RunState::Diverged);
            }
            let result = json(&folder.join(RESULT), "the result of a run")?;
            Snapshot::read(&folder.join(POLICY))?;
            Ok(RunState::Finished(Box::new(result)))
        };
        whole().unwrap_or_else(|BadInput { place, found, .. }| RunState::Damaged(format!("{place}: {found}")))
    }

    /// Puts a damaged run aside, where it can be looked at; says where.
    pub fn set_aside(&self, name: &str) -> Result<PathBuf> {
        let (from, to) = (self.run(name), fsio::free(&self.path.join(ASIDE).join(name)));
        let moved = std::fs::create_dir_all(self.path.join(ASIDE)).and_then(|()| std::fs::rename(&from, &to));
        moved.map_err(Error::write(&from))?;
        Ok(to)
    }

    /// The results of all that is finished.
    pub fn results(&self) -> Result<Results> {
        let plan: StudyPlan = json(&self.path.join(PLAN), "the plan of a study")?;
        plan.check().map_err(|invalid| BadInput::at(self.path.join(PLAN).display(), invalid))?;
        let (mut runs, mut diverged) = (Vec::new(), Vec::new());
        for run in &plan.runs {
            let state = self.state(&run.name);
            if let RunState::Diverged = state {
                diverged.push(run.name.clone());
            }
            runs.push(if let RunState::Finished(result) = state { Some(*result) } else { None });
        }
        Ok(Results::new(plan, runs, diverged))
    }

    /// Writes the tables of all that is finished, in place of earlier ones.
    pub fn write_tables(&self) -> Result<Results> {
        loop {
            let results = self.results()?;
            for (name, bytes) in tables::files(&results)? {
                let path = self.path.join(name);
                fsio::replace(&path, &bytes).map_err(Error::write(&path))?;
            }
            // Another process may have finished a run in the meantime, and have written its tables before these.
            let finished = results.plan.runs.iter().filter(|run| self.finished(&run.name)).count();
            if finished == results.finished() {
                return Ok(results);
            }
        }
    }
}

fn json<T: serde::de::DeserializeOwned>(path: &Path, expected: &str) -> Result<T, BadInput> {
    let failed = |error: String| BadInput::new(path.display(), error, expected, "");
    let bytes = std::fs::read(path).map_err(|error| failed(error.to_string()))?;
    serde_json::from_slice(&bytes).map_err(|error| failed(error.to_string()))
}

/// Makes sure that the run in `folder` was made with `setup`.
pub fn same(folder: &Path, setup: &Setup) -> Result<()> {
    for (name, wanted) in resolved::files(setup)? {
        let path = folder.join(name);
        let there = std::fs::read_to_string(&path).unwrap_or_default();
        if there != wanted {
            let (wanted, there) = first_difference(&wanted, &there);
            let expected = format!("{wanted}, as the study now asks for");
            let advice = "choose another folder (--out) for the changed study, or change it back";
            return Err(BadInput::new(path.display(), format!("a finished run with {there}"), &expected, advice).into());
        }
    }
    Ok(())
}

/// The first lines that differ, each with its table.
fn first_difference(a: &str, b: &str) -> (String, String) {
    let lines = |text: &str| {
        let mut table = String::new();
        let mut named = Vec::new();
        for line in text.lines().filter(|line| !line.trim().is_empty()) {
            if line.starts_with('[') {
                table = format!("{line} ");
            } else {
                named.push(format!("{table}{line}"));
            }
        }
        named
    };
    let (a, b) = (lines(a), lines(b));
    let place = (0..a.len().max(b.len())).find(|&i| a.get(i) != b.get(i)).unwrap_or_default();
    let line = |lines: &[String]| lines.get(place).map_or("nothing".into(), |line| format!("`{line}`"));
    (line(&a), line(&b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_named_with_their_table() {
        let (a, b) = first_difference("x = 1\n\n[ppo]\nclip = 2\n", "x = 1\n\n[ppo]\nclip = 3\n");
        assert_eq!((a.as_str(), b.as_str()), ("`[ppo] clip = 2`", "`[ppo] clip = 3`"));
        assert_eq!(first_difference("x = 1\n", "").1, "nothing");
    }
}
