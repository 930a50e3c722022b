//! A firmware's own simulator build as a process, in a folder of its own that goes with it.

use crate::base::check::BadInput;
use crate::base::error::{Error, Result};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use tempfile::TempDir;

/// Whose firmware it is, and how a user comes by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Maker {
    pub name: &'static str,
    /// How to build it.
    pub build: &'static str,
    /// Names of the logs that it writes end so.
    pub log: &'static str,
}

impl Maker {
    /// The program at `path` is none of this maker's simulator builds: `found` is what it is instead.
    pub fn refusal(&self, path: &Path, found: String) -> BadInput {
        let expected = format!("{}'s simulator build", self.name);
        BadInput::new(format!("--firmware {}", path.display()), found, &expected, self.build)
    }

    /// Where the program at `path` is, for a process in another folder; an error where there is none.
    pub fn find(&self, path: &Path) -> std::result::Result<PathBuf, BadInput> {
        fs::canonicalize(path).map_err(|error| self.refusal(path, error.to_string()))
    }
}

/// A running firmware. It ends with this.
#[derive(Debug)]
pub struct Firmware {
    child: Child,
    folder: TempDir,
    maker: Maker,
    /// Lines of the user's own settings that it said it did not take.
    pub refused: Vec<String>,
}

const OUTPUT: &str = "output.txt";

/// A folder for a firmware. Fails where none can be made.
pub fn folder() -> Result<TempDir> {
    tempfile::tempdir().map_err(|error| Error::Failed(format!("no temporary folder: {error}")))
}

impl Firmware {
    /// Runs `command`, `maker`'s firmware, in `folder`. Fails where it cannot be run.
    pub fn run(maker: Maker, mut command: Command, folder: TempDir, refused: Vec<String>) -> Result<Self> {
        let output = File::create(folder.path().join(OUTPUT)).map_err(Error::write(folder.path()))?;
        let errors = output.try_clone().map_err(Error::write(folder.path()))?;
        command.current_dir(folder.path()).stdin(Stdio::null()).stderr(errors).stdout(output);
        let program = PathBuf::from(command.get_program());
        let child = command.spawn().map_err(|error| maker.refusal(&program, error.to_string()))?;
        Ok(Self { child, folder, maker, refused })
    }

    /// How it ended, if it has.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().ok().flatten()
    }

    /// The last that it printed of why it does not arm, or else of anything.
    pub fn last_words(&self) -> String {
        let output = fs::read(self.folder.path().join(OUTPUT)).unwrap_or_default();
        let output = String::from_utf8_lossy(&output);
        let why = output.lines().rev().find(|line| line.contains("Arming disabled"));
        // ArduPilot says of every port that is not used that it is not.
        let mut lines = output.lines().rev();
        let last = why.or(lines.find(|line| !line.trim().is_empty() && !line.starts_with("Skipping port")));
        format!("the firmware printed last: {}", last.unwrap_or("nothing"))
    }

    /// Its newest log, if it wrote one.
    pub fn blackbox(&self) -> Option<Vec<u8>> {
        let folders = [self.folder.path().to_path_buf(), self.folder.path().join("logs")];
        let entries = folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten();
        let logs = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let newest: Option<PathBuf> = logs.filter(|path| path.extension().is_some_and(|e| e == self.maker.log)).max();
        newest.and_then(|path| fs::read(path).ok())
    }
}

impl Drop for Firmware {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
