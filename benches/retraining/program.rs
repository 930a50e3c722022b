//! The shipped program, and the folder that it works in.

use crate::args::Args;
use racer::flight::Log;
use racer::model::vehicle::Vehicle;
use racer::race::snapshot::Snapshot;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What `racer eval` says of fixed starts.
#[derive(Clone, Copy, Debug)]
pub struct Simulated {
    pub completion: f64,
    pub lap_s: Option<f64>,
}

/// Goes again unless it is kept.
pub struct Folder<'a> {
    args: &'a Args,
    path: PathBuf,
    // Removes it at the end.
    _gone: Option<tempfile::TempDir>,
}

impl<'a> Folder<'a> {
    /// # Panics
    ///
    /// Where none can be made, or something is in the one to keep.
    pub fn new(args: &'a Args) -> Self {
        if let Some(keep) = &args.keep {
            let path = std::path::absolute(keep).expect("a path");
            std::fs::create_dir_all(&path).expect("the folder to keep");
            let used = std::fs::read_dir(&path).expect("the folder to keep").next().is_some();
            assert!(!used, "{} is not empty", path.display());
            return Folder { args, path, _gone: None };
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        Folder { args, path: folder.path().to_path_buf(), _gone: Some(folder) }
    }

    /// Writes `base.toml`.
    pub fn write_base(&self, vehicle: &Vehicle) {
        let base = Vehicle { name: "base".into(), ..vehicle.clone() };
        std::fs::write(self.path.join("base.toml"), toml::to_string(&base).expect("a vehicle is TOML")).expect("base");
    }

    /// The name of the vehicle that the diagnosis of `log` extends, if it does, and what it found.
    pub fn diagnose(&self, id: &str, log: &Log) -> (Option<String>, String) {
        let [flight, answer, extended] = ["mcap", "json", "toml"].map(|kind| format!("{id}.{kind}"));
        let bytes = racer::flight::write::mcap(log).expect("a log can be written");
        std::fs::write(self.path.join(&flight), bytes).expect("the log");
        let to = ["diagnose", &flight, "--vehicle", "base.toml", "--extend", &extended, "--json", &answer];
        let ran = self.run(&to);
        let written = self.path.join(&extended).is_file();
        let found = match (ran, std::fs::read_to_string(self.path.join(&answer))) {
            (Err(error), _) => error,
            (Ok(()), Err(error)) => format!("no answer: {error}"),
            (Ok(()), Ok(text)) => found(&serde_json::from_str(&text).expect("the answer is JSON")),
        };
        let found = if written { found } else { format!("{found}; nothing extended") };
        (written.then_some(extended), found)
    }

    /// The best policy of a training in `vehicle`, whose folder is `run`.
    ///
    /// # Panics
    ///
    /// Where there is none.
    pub fn train(&self, vehicle: &str, run: &str, seed: u64) -> Snapshot {
        let (seed, budget) = (seed.to_string(), self.args.budget());
        let mut to = vec!["train", "--vehicle", vehicle, "--seed", &seed, "--out", run];
        to.extend(budget.iter().map(String::as_str));
        let track = self.args.track.as_deref().map(name_or_file);
        to.extend(track.iter().flat_map(|track| ["--track", track]));
        self.run(&to).unwrap_or_else(|error| panic!("{run}: {error}"));
        let path = self.path.join(run).join(racer::present::run::POLICY);
        Snapshot::read(&path).unwrap_or_else(|error| panic!("{run}: {error}"))
    }

    /// What the policy of `run` is worth in racer's own simulator of `vehicle`; `name` tells one result from another.
    pub fn evaluate(&self, run: &str, vehicle: &str, name: &str) -> Option<Simulated> {
        let (out, agents) = (format!("{run}-in-{name}.json"), self.args.agents.to_string());
        self.run(&["eval", run, "--vehicle", vehicle, "--start", "fixed", "--agents", &agents, "--out", &out]).ok()?;
        let json: Value = serde_json::from_str(&std::fs::read_to_string(self.path.join(out)).ok()?).ok()?;
        let completion = json["fixed"]["lap_completion"].as_f64()?;
        Some(Simulated { completion, lap_s: json["fixed"]["lap_time_s"]["median"].as_f64() })
    }

    /// Runs the program here; an error is the first line that it wrote.
    fn run(&self, arguments: &[&str]) -> Result<(), String> {
        // A relative path would be looked for from the folder.
        let program = std::path::absolute(&self.args.racer).map_err(|error| error.to_string())?;
        let output = Command::new(&program).args(arguments).current_dir(&self.path).output();
        let output = output.map_err(|error| format!("{}: {error}", program.display()))?;
        if output.status.success() {
            return Ok(());
        }
        let error = String::from_utf8_lossy(&output.stderr);
        let line = error.lines().find(|line| !line.trim().is_empty()).unwrap_or("no message");
        Err(format!("{} {}: {line}", arguments[0], output.status))
    }
}

/// A file is looked for from another folder.
fn name_or_file(text: &str) -> String {
    let path = Path::new(text);
    let path = if path.is_file() { std::path::absolute(path).expect("a path") } else { path.into() };
    path.display().to_string()
}

/// The verdict, and names with their parameters.
fn found(answer: &Value) -> String {
    let findings = answer["findings"].as_array().map_or(&[][..], Vec::as_slice);
    let one = |finding: &Value| {
        let parameters = finding["parameters"].as_object().into_iter().flatten();
        let values: Vec<String> =
            parameters.filter_map(|(name, of)| Some(format!("{name} {:.4}", of["value"].as_f64()?))).collect();
        let text = |key: &str| finding[key].as_str().unwrap_or("?").to_string();
        format!("{} ({}; {})", text("effect"), text("status"), values.join(", "))
    };
    let verdict = answer["verdict"].as_str().unwrap_or("no verdict").to_string();
    std::iter::once(verdict).chain(findings.iter().map(one)).collect::<Vec<_>>().join("; ")
}
