//! How ArduPilot's simulator build is set up and started.

use super::super::firmware::{Firmware, Maker, folder};
use super::wire::ArduPilotWire;
use crate::base::error::{Error, Result};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

pub const ARDUPILOT: Maker = Maker {
    name: "ArduCopter",
    build: "build it with `./waf configure --board sitl && ./waf copter` in ArduPilot's sources (docs/flying.md)",
    log: "BIN",
};

const PARAMETERS: &str = "racer.parm";
/// Longest time from its start to its first word, s, and how often it is looked whether it still runs.
const SPEAK_S: u64 = 5;
const LOOK_S: f64 = 0.1;

/// Starts the program at the absolute `path` with the `parameters` of a file, and waits until it speaks. Fails where it
/// is no such firmware, which shows in its end or its silence.
pub fn start(path: &Path, parameters: &str, wire: &mut ArduPilotWire) -> Result<Firmware> {
    let folder = folder()?;
    fs::write(folder.path().join(PARAMETERS), parameters).map_err(Error::write(folder.path()))?;
    let [physics, link] = wire.ports().map(|port| port.to_string());
    let mut fly = Command::new(path);
    // Somewhere on dry land, at the sea's level.
    fly.args(["--model", "JSON:127.0.0.1", "--home", "52,5,0,0", "--defaults", PARAMETERS]);
    fly.args(["--sim-port-out", &physics, "--serial0", &format!("udpclient:127.0.0.1:{link}")]);
    for port in 1..=9 {
        fly.args([format!("--serial{port}"), "none:".to_string()]);
    }
    let mut firmware = Firmware::run(ARDUPILOT, fly, folder, Vec::new())?;
    let looks = (SPEAK_S as f64 / LOOK_S) as usize;
    for _ in 0..looks {
        if wire.spoke_within(Duration::from_secs_f64(LOOK_S))? {
            return Ok(firmware);
        }
        if let Some(status) = firmware.ended() {
            let found = format!("a program that ends at once ({status}); {}", firmware.last_words());
            return Err(ARDUPILOT.refusal(path, found).into());
        }
    }
    let found = format!("a program that sends no servo outputs within {SPEAK_S} s; {}", firmware.last_words());
    Err(ARDUPILOT.refusal(path, found).into())
}
