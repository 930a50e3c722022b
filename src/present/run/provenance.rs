//! Which program on which machine made a run.

use crate::base::lane::Level;
use crate::base::threads::processors;
use serde::Serialize;
use std::time::SystemTime;

/// What a result has to be read with.
#[derive(Clone, Debug, Serialize)]
pub struct Provenance {
    pub racer: &'static str,
    /// When it began, UTC.
    pub started: String,
    pub cpu: String,
    pub architecture: &'static str,
    pub os: &'static str,
    /// Logical processors that this process may use.
    pub processors: usize,
    /// Threads that it did use; changes the speed and not the result.
    pub threads: usize,
    pub simd: String,
}

impl Provenance {
    /// Of this process, now.
    pub fn now(level: Level, threads: usize) -> Self {
        Self {
            racer: env!("CARGO_PKG_VERSION"),
            started: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            cpu: cpu(),
            architecture: std::env::consts::ARCH,
            os: std::env::consts::OS,
            processors: processors(),
            threads,
            simd: level.to_string(),
        }
    }
}

/// The processor's name, where the system tells.
fn cpu() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with("model name"));
    line.and_then(|line| line.split_once(": ")).map_or("unknown", |(_, name)| name.trim()).into()
}
