//! What several tests need: the program, the interpreter of Python, flight data.

// Either test program uses its own part.
#![allow(dead_code)]

pub mod feed;
pub mod tongue;
pub mod ulog;
pub mod vehicle;

use assert_cmd::Command;
use std::io::Write;
use std::path::{Path, PathBuf};

/// How a run of the program ended, and what it printed.
pub struct Ran {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// `racer args` in `folder`.
pub fn racer(folder: &Path, args: &[&str]) -> Ran {
    Ran::of(Command::cargo_bin("racer").unwrap().current_dir(folder).args(args))
}

impl Ran {
    /// What `command` does.
    pub fn of(command: &mut Command) -> Self {
        let output = command.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Self { code: output.status.code().unwrap(), out: text(output.stdout), err: text(output.stderr) }
    }
}

/// Says that a test is skipped because something is missing; fails where the environment has the variable `required`.
pub fn skipped(missing: &str, required: &str) {
    assert!(std::env::var_os(required).is_none(), "{missing} is required");
    // Past the capture of what tests print.
    std::io::stderr().write_all(format!("SKIPPED: {missing} is not there\n").as_bytes()).unwrap();
}

/// Runs Python with `args`, if `RACER_PYTHON` (default `python3`) has the modules `imports`; its standard output.
pub fn python(imports: &str, args: &[&Path]) -> Option<Vec<u8>> {
    use std::process::Command;
    let interpreter = std::env::var_os("RACER_PYTHON").unwrap_or("python3".into());
    let available = Command::new(&interpreter).args(["-c", &format!("import {imports}")]).output();
    if !available.is_ok_and(|output| output.status.success()) {
        skipped(&format!("python3 with the modules {imports}"), "RACER_REQUIRE_PYTHON");
        return None;
    }
    let output = Command::new(&interpreter).args(args).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(output.stdout)
}

/// A file or folder of the flight data, where it is there.
pub fn flight_data(name: &str) -> Option<PathBuf> {
    let root = std::env::var_os("RACER_FLIGHT_DATA").map_or("../shared/flight-data".into(), PathBuf::from);
    let path = root.join(name);
    if !path.exists() {
        println!("skipped: no {} (RACER_FLIGHT_DATA says where flight data is)", path.display());
        return None;
    }
    Some(path)
}
