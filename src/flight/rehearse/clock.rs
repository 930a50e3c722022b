//! Whose time a rehearsal goes by.
//!
//! In lockstep the firmware is given racer's time: a small library (`clock.c`, compiled by the system's C compiler) is
//! preloaded and answers whenever it asks for the time or sleeps. Its program stays as it was built. By the wall, both
//! go as real time does, which needs an idle machine.

use super::STEP_S;
use crate::base::check::BadInput;
use crate::base::error::{Error, Result};
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

const SOURCE: &str = include_str!("clock.c");
/// Time that the firmware has for booting before the first step, s.
const BOOT_S: f64 = 1.0;
/// Longest wait for an answer, s.
const ANSWER_S: f64 = 10.0;

/// See the module.
#[derive(Debug)]
pub enum SharedClock {
    Lockstep {
        /// Where the firmware's clock says that time is used up, or sticks are taken.
        told: UdpSocket,
    },
    Wall {
        begun: Instant,
        steps: u64,
        /// Steps that began more than a step late.
        late: u64,
    },
}

impl SharedClock {
    /// Lockstep, where the firmware's clock, or a test, speaks to that port.
    pub fn lockstep() -> Result<Self> {
        Self::lockstep_within(ANSWER_S)
    }

    /// The same with another longest wait, s.
    pub fn lockstep_within(longest_s: f64) -> Result<Self> {
        let told = UdpSocket::bind(("127.0.0.1", 0)).map_err(|error| Error::Failed(format!("no socket: {error}")))?;
        let wait = Some(Duration::from_secs_f64(longest_s));
        told.set_read_timeout(wait).map_err(|error| Error::Failed(error.to_string()))?;
        Ok(Self::Lockstep { told })
    }

    /// Real time from now on.
    pub fn wall() -> Self {
        Self::Wall { begun: Instant::now(), steps: 0, late: 0 }
    }

    /// Where it listens; none by the wall.
    pub fn port(&self) -> Option<u16> {
        match self {
            Self::Lockstep { told } => told.local_addr().ok().map(|address| address.port()),
            Self::Wall { .. } => None,
        }
    }

    /// Prepares `command`, whose program is to go by this clock; `folder` is for the library.
    pub fn give(&self, command: &mut Command, folder: &Path) -> Result<(), BadInput> {
        let Some(port) = self.port() else { return Ok(()) };
        let nanoseconds = |seconds: f64| format!("{:.0}", 1e9 * seconds);
        command.env("LD_PRELOAD", library(folder)?);
        command.env("RACER_CLOCK_PORT", port.to_string());
        command.env("RACER_CLOCK_STEP_NS", nanoseconds(STEP_S));
        command.env("RACER_CLOCK_BEGIN_NS", nanoseconds(BOOT_S));
        Ok(())
    }

    /// Waits until the firmware has booted; by the wall it has to have within that time.
    pub fn begin(&mut self) -> Result<()> {
        match self {
            Self::Lockstep { told } => hear(told, b't'),
            Self::Wall { begun, .. } => {
                std::thread::sleep(Duration::from_secs_f64(BOOT_S));
                *begun = Instant::now();
                Ok(())
            }
        }
    }

    /// Waits until sticks that were sent are taken.
    pub fn after_sticks(&mut self) -> Result<()> {
        match self {
            Self::Lockstep { told } => hear(told, b'r'),
            Self::Wall { .. } => Ok(()),
        }
    }

    /// Waits until the firmware has flown the step that a state began.
    pub fn after_step(&mut self) -> Result<()> {
        match self {
            Self::Lockstep { told } => hear(told, b't'),
            Self::Wall { begun, steps, late } => {
                *steps += 1;
                let ahead = *steps as f64 * STEP_S - begun.elapsed().as_secs_f64();
                *late += u64::from(ahead < -STEP_S);
                std::thread::sleep(Duration::from_secs_f64(ahead.max(0.0)));
                Ok(())
            }
        }
    }

    /// Steps that began late, and all; none in lockstep.
    pub fn late(&self) -> Option<[u64; 2]> {
        match *self {
            Self::Lockstep { .. } => None,
            Self::Wall { late, steps, .. } => Some([late, steps]),
        }
    }
}

fn hear(told: &UdpSocket, what: u8) -> Result<()> {
    let mut byte = [0];
    let failed = |why: String| Error::Failed(format!("the firmware does not keep racer's time: {why}"));
    match told.recv(&mut byte) {
        Ok(_) if byte[0] == what => Ok(()),
        Ok(_) => Err(failed(format!("heard {:?} for {:?}", char::from(byte[0]), char::from(what)))),
        Err(error) => Err(failed(format!("{error}; where it is linked statically, --clock wall"))),
    }
}

/// The library, compiled into `folder`.
fn library(folder: &Path) -> Result<PathBuf, BadInput> {
    let refuse = |found: String| {
        BadInput::new("--clock lockstep", found, "Linux and a C compiler (`cc`)", "install one, or take --clock wall")
    };
    if !cfg!(target_os = "linux") {
        return Err(refuse("another system".into()));
    }
    let (source, library) = (folder.join("clock.c"), folder.join("clock.so"));
    std::fs::write(&source, SOURCE).map_err(|error| refuse(error.to_string()))?;
    let mut compile = Command::new("cc");
    compile.args(["-O2", "-shared", "-fPIC", "-o"]).args([&library, &source]).args(["-ldl", "-lpthread"]);
    let done = compile.output().map_err(|error| refuse(format!("cc: {error}")))?;
    if !done.status.success() {
        return Err(refuse(String::from_utf8_lossy(&done.stderr).trim().to_string()));
    }
    Ok(library)
}
