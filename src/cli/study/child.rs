//! One run as a process of its own: one that crashes takes nothing along, and none outlives the study.

use crate::cli::interrupt;
use crate::race::config::Setting;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Mutex;
use std::time::Duration;

/// Time between two looks at the process.
const LOOK: Duration = Duration::from_millis(50);
/// Lines of a failed run that are shown.
const TAIL: usize = 15;

/// What a training comes from and goes to.
pub struct ChildTraining<'a> {
    pub config: &'a str,
    pub settings: &'a [Setting],
    pub threads: usize,
    pub out: &'a Path,
}

/// How it ended.
pub enum ChildEnd {
    Trained,
    /// Because the study was asked to end.
    Stopped,
    /// With the last lines that it wrote.
    Failed(String),
}

/// Trains with `racer train`, telling `heard` each of its lines.
pub fn train(training: &ChildTraining, heard: &(dyn Fn(&str) + Sync)) -> anyhow::Result<ChildEnd> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["train", "--attached", "--config", training.config]);
    for setting in training.settings {
        command.args(["--set", &format!("{}={}", setting.key, setting.value)]);
    }
    command.args(["--threads", &training.threads.to_string(), "--out"]).arg(training.out);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn()?;
    let lines = Mutex::new(Vec::new());
    let error = child.stderr.take();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            for line in error.into_iter().flat_map(|error| BufReader::new(error).lines().map_while(Result::ok)) {
                heard(&line);
                if let Ok(mut lines) = lines.lock() {
                    lines.push(line);
                }
            }
        });
        wait(&mut child)
    })
    .map(|status| match status {
        None => ChildEnd::Stopped,
        Some(status) if status.success() => ChildEnd::Trained,
        Some(status) => {
            let lines = lines.into_inner().unwrap_or_default();
            let tail = lines[lines.len().saturating_sub(TAIL)..].join("\n  ");
            ChildEnd::Failed(format!("{status}\n  {tail}"))
        }
    })
}

/// Waits for the end; `None` where it was brought about by the study's.
fn wait(child: &mut Child) -> anyhow::Result<Option<ExitStatus>> {
    loop {
        if let Some(status) = child.try_wait()? {
            // Ctrl-C on a terminal reaches both.
            return Ok((!interrupt::asked()).then_some(status));
        }
        if interrupt::asked() {
            // The process ends where its input does; should it not, it is made to.
            drop(child.stdin.take());
            for _ in 0..40 {
                if child.try_wait()?.is_some() {
                    return Ok(None);
                }
                std::thread::sleep(LOOK);
            }
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        std::thread::sleep(LOOK);
    }
}
