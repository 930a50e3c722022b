//! How Betaflight's simulator build is set up and started.

use super::super::clock::SharedClock;
use super::super::firmware::{Firmware, Maker, folder};
use crate::base::error::{Error, Result};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

pub const BETAFLIGHT: Maker = Maker {
    name: "Betaflight",
    build: "build it with `make TARGET=SITL` in Betaflight's sources (docs/flying.md)",
    log: "BFL",
};

/// How it marks a line that it does not take.
const REFUSED: &str = "###ERROR";

/// Sets up and starts the program at the absolute `path`: with the `user`'s own command lines first, `settings` over
/// them, and the time of `clock`. Fails where it is no such firmware.
pub fn start(path: &Path, user: &str, settings: &str, clock: &SharedClock) -> Result<Firmware> {
    let folder = folder()?;
    let own = |line: &&str| !["save", "batch", "exit", "defaults"].iter().any(|word| line.trim().starts_with(word));
    let user: String = user.lines().filter(own).flat_map(|line| [line, "\n"]).collect();
    let lines = format!("{user}\n{settings}save\n");
    fs::write(folder.path().join("settings.txt"), lines).map_err(Error::write(folder.path()))?;
    let mut set_up = Command::new(path);
    set_up.args(["--config", "settings.txt"]).current_dir(folder.path()).stdin(Stdio::null());
    let said = set_up.output().map_err(|error| BETAFLIGHT.refusal(path, error.to_string()))?;
    let said = String::from_utf8_lossy(&said.stdout).into_owned();
    if !said.contains("EEPROM saved") {
        let last = said.lines().last().unwrap_or("nothing");
        let found = format!("a program that does not read its settings (--config); it said: {last}");
        return Err(BETAFLIGHT.refusal(path, found).into());
    }
    let refused: Vec<_> = said.lines().filter(|line| line.contains(REFUSED)).map(str::to_string).collect();
    let mut fly = Command::new(path);
    clock.give(&mut fly, folder.path())?;
    Firmware::run(BETAFLIGHT, fly, folder, refused)
}
