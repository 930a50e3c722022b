//! Writes a log and the vehicle without effects, and runs the program on nothing else.

use crate::answer::Answer;
use crate::args::Args;
use crate::case::Case;
use crate::extended::{EXTENDED, Extended};
use crate::judge::Judged;
use crate::rows::Row;
use crate::truth::hidden::{self, Setting};
use racer::flight::Log;
use racer::model::vehicle::Vehicle;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Names of a log and of the vehicle that it is taken for.
pub const LOG: &str = "log.mcap";
pub const VEHICLE: &str = "base.toml";
const OUT: &str = "out.json";

/// A folder for one log, which goes again unless it is kept.
pub struct Folder {
    pub path: PathBuf,
    // Removes it at the end.
    _gone: Option<tempfile::TempDir>,
}

impl Folder {
    /// # Panics
    ///
    /// Where none can be made.
    pub fn new(args: &Args, name: &str) -> Self {
        match &args.keep {
            Some(keep) => {
                let path = std::path::absolute(keep).expect("a path").join(name);
                std::fs::create_dir_all(&path).expect("the folder to keep");
                Folder { path, _gone: None }
            }
            None => {
                let folder = tempfile::tempdir().expect("a temporary folder");
                Folder { path: folder.path().to_path_buf(), _gone: Some(folder) }
            }
        }
    }
}

/// Flies, diagnoses and judges a case.
pub fn case(case: &Case, args: &Args) -> Judged {
    let folder = Folder::new(args, &format!("{:04}", case.number));
    let log = hidden::fly(&case.flown, &case.hidden, &case.setting);
    let (answer, seconds) = diagnose(args, &folder.path, &log, &case.base.in_racer());
    let unseen = |setting: &Setting| hidden::fly(&case.flown, &case.hidden, setting);
    let extended = Extended::of(args, &folder.path, &case.setting, unseen);
    let hidden = case.hidden.clone();
    let judged = Judged { group: case.group, hidden, before: Vec::new(), answer, seconds, extended };
    if args.keep.is_some() {
        let truth = format!("{}\n{case:#?}\n", judged.line());
        std::fs::write(folder.path.join("truth.txt"), truth).expect("the truth to keep");
    }
    judged
}

/// What the program answers to `log` and the vehicle `base`, and how long it took, s.
pub fn diagnose(args: &Args, folder: &Path, log: &Log, base: &Vehicle) -> (Result<Answer, String>, f64) {
    let base = Vehicle { name: "base".into(), ..base.clone() };
    write(folder, log);
    std::fs::write(folder.join(VEHICLE), toml::to_string(&base).expect("a vehicle is TOML")).expect("the vehicle");
    let _ = std::fs::remove_file(folder.join(OUT));
    let start = Instant::now();
    let _ = std::fs::remove_file(folder.join(EXTENDED));
    let mut asked = vec!["diagnose", LOG, "--vehicle", VEHICLE, "--json", OUT];
    if args.extended {
        asked.extend(["--extend", EXTENDED]);
    }
    let ran = run(args, folder, &asked);
    let seconds = start.elapsed().as_secs_f64();
    let answer = match (std::fs::read_to_string(folder.join(OUT)), ran) {
        (Ok(text), _) => Answer::read(&text),
        (Err(_), Err(error)) => Err(error),
        (Err(error), Ok(())) => Err(format!("it wrote no {OUT}: {error}")),
    };
    (answer, seconds)
}

/// Writes `log` under its neutral name.
pub fn write(folder: &Path, log: &Log) {
    let bytes = racer::flight::write::mcap(log).expect("a log can be written");
    std::fs::write(folder.join(LOG), bytes).expect("the log");
}

/// Runs the program in `folder`; an error is the first it wrote.
pub fn run(args: &Args, folder: &Path, arguments: &[&str]) -> Result<(), String> {
    said(args, folder, arguments).map(|_| ())
}

/// What the program prints.
pub fn said(args: &Args, folder: &Path, arguments: &[&str]) -> Result<String, String> {
    // A relative path would be looked for from the folder.
    let program = std::path::absolute(&args.racer).map_err(|error| error.to_string())?;
    let output = Command::new(&program).args(arguments).current_dir(folder).output();
    let output = output.map_err(|error| format!("{}: {error}", program.display()))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let error = String::from_utf8_lossy(&output.stderr);
    let line = error.lines().find(|line| !line.trim().is_empty()).unwrap_or("no message").to_string();
    Err(format!("{}: {line}", output.status))
}
