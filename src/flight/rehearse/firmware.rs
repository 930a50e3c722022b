//! The firmware's own simulator build as a process, in a folder of its own that goes with it.

use super::clock::SharedClock;
use crate::base::check::BadInput;
use crate::base::error::{Error, Result};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

/// A running firmware. It ends with this.
#[derive(Debug)]
pub struct Firmware {
    child: Child,
    folder: TempDir,
    /// Lines of the user's own settings that it did not take.
    pub refused: Vec<String>,
}

const OUTPUT: &str = "output.txt";
/// How it marks a line that it does not take.
const REFUSED: &str = "###ERROR";

fn refusal(path: &Path, found: String) -> BadInput {
    let advice = "build it with `make TARGET=SITL` in Betaflight's sources (docs/flying.md)";
    BadInput::new(format!("--firmware {}", path.display()), found, "Betaflight's simulator build", advice)
}

/// Where the program at `path` is, for a process in another folder; an error where there is none.
pub fn find(path: &Path) -> std::result::Result<PathBuf, BadInput> {
    fs::canonicalize(path).map_err(|error| refusal(path, error.to_string()))
}

impl Firmware {
    /// Sets up and starts the program at the absolute `path`: with the `user`'s own command lines first, `settings`
    /// over them, and the time of `clock`.
    pub fn start(path: &Path, user: &str, settings: &str, clock: &SharedClock) -> Result<Self> {
        let refuse = |found: String| refusal(path, found);
        let folder = tempfile::tempdir().map_err(|error| Error::Failed(format!("no temporary folder: {error}")))?;
        let own = |line: &&str| !["save", "batch", "exit", "defaults"].iter().any(|word| line.trim().starts_with(word));
        let user: String = user.lines().filter(own).flat_map(|line| [line, "\n"]).collect();
        let lines = format!("{user}\n{settings}save\n");
        fs::write(folder.path().join("settings.txt"), lines).map_err(Error::write(folder.path()))?;
        let mut set_up = Command::new(path);
        set_up.args(["--config", "settings.txt"]).current_dir(folder.path()).stdin(Stdio::null());
        let said = set_up.output().map_err(|error| refuse(error.to_string()))?;
        let said = String::from_utf8_lossy(&said.stdout).into_owned();
        if !said.contains("EEPROM saved") {
            let last = said.lines().last().unwrap_or("nothing");
            return Err(refuse(format!("a program that does not read its settings (--config); it said: {last}")).into());
        }
        let refused: Vec<_> = said.lines().filter(|line| line.contains(REFUSED)).map(str::to_string).collect();
        let output = File::create(folder.path().join(OUTPUT)).map_err(Error::write(folder.path()))?;
        let mut fly = Command::new(path);
        fly.current_dir(folder.path()).stdin(Stdio::null()).stderr(Stdio::null()).stdout(output);
        clock.give(&mut fly, folder.path())?;
        let child = fly.spawn().map_err(|error| refuse(error.to_string()))?;
        Ok(Self { child, folder, refused })
    }

    /// The last that it printed of why it does not arm, or else of anything.
    pub fn last_words(&self) -> String {
        let output = fs::read(self.folder.path().join(OUTPUT)).unwrap_or_default();
        let output = String::from_utf8_lossy(&output);
        let why = output.lines().rev().find(|line| line.contains("Arming disabled"));
        format!("the firmware said last: {}", why.or(output.lines().last()).unwrap_or("nothing"))
    }

    /// Its newest blackbox log, if it wrote one.
    pub fn blackbox(&self) -> Option<Vec<u8>> {
        let entries = fs::read_dir(self.folder.path()).ok()?;
        let logs = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let newest: Option<PathBuf> = logs.filter(|path| path.extension().is_some_and(|e| e == "BFL")).max();
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
