//! The logs of a training, written row by row as it goes. What a killed process leaves is whole but for the last row,
//! of which a part may be there: readers leave it out, and going on takes it back.

use super::metrics::{self, LogRow};
use super::{Run, TENSORBOARD, tensorboard};
use crate::base::error::{Error, Result};
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::time::SystemTime;

/// Both logs.
#[derive(Debug)]
pub struct LiveLogs {
    metrics: LiveFile,
    events: LiveFile,
    started: SystemTime,
}

/// How long both files are, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct LogLengths {
    pub metrics: u64,
    pub events: u64,
}

impl LiveLogs {
    /// The logs of `run`, new or to be gone on with.
    pub fn open(run: &Run) -> Result<Self> {
        let started = SystemTime::now();
        let new = || run.folder.join(TENSORBOARD).join(tensorboard::file_name(started));
        let events = events(run).unwrap_or_else(new);
        let metrics = LiveFile::open(run.folder.join(metrics::METRICS))?;
        Ok(Self { metrics, events: LiveFile::open(events)?, started })
    }

    /// Adds a row to either.
    pub fn append(&mut self, row: &LogRow) -> Result<()> {
        let header = self.metrics.length == 0;
        self.metrics.append(&metrics::to_csv(std::slice::from_ref(row), header)?)?;
        let mut events = Vec::new();
        if self.events.length == 0 {
            events.extend(tensorboard::version(self.started));
        }
        events.extend(tensorboard::event(row));
        self.events.append(&events)
    }

    /// How long they are now.
    pub fn lengths(&self) -> LogLengths {
        LogLengths { metrics: self.metrics.length, events: self.events.length }
    }

    /// Takes back all that was added since they had these lengths. Fails where they were never so long.
    pub fn cut(&mut self, to: LogLengths) -> Result<()> {
        self.metrics.cut(to.metrics)?;
        self.events.cut(to.events)
    }

    /// Makes sure that all of it survives a loss of power.
    pub fn sync(&self) -> Result<()> {
        [&self.metrics, &self.events]
            .into_iter()
            .try_for_each(|log| log.file.sync_data().map_err(Error::write(&log.path)))
    }
}

/// How long the logs of `run` are.
pub fn lengths(run: &Run) -> LogLengths {
    let length = |path: PathBuf| std::fs::metadata(path).map_or(0, |file| file.len());
    LogLengths { metrics: length(run.folder.join(metrics::METRICS)), events: events(run).map_or(0, length) }
}

/// The event file of `run`, if there is one.
fn events(run: &Run) -> Option<PathBuf> {
    let there = std::fs::read_dir(run.folder.join(TENSORBOARD)).ok()?;
    there.flatten().map(|entry| entry.path()).max()
}

/// A file that only grows.
#[derive(Debug)]
struct LiveFile {
    path: PathBuf,
    file: File,
    length: u64,
}

impl LiveFile {
    fn open(path: PathBuf) -> Result<Self> {
        let open = || -> std::io::Result<_> {
            let file = File::options().append(true).create(true).open(&path)?;
            let length = file.metadata()?.len();
            Ok((file, length))
        };
        let (file, length) = open().map_err(Error::write(&path))?;
        Ok(Self { path, file, length })
    }

    /// All of `bytes` or nothing.
    fn append(&mut self, bytes: &[u8]) -> Result<()> {
        if let Err(error) = self.file.write_all(bytes) {
            // What was written of them is no row.
            let _ = self.file.set_len(self.length);
            return Err(Error::write(&self.path)(error));
        }
        self.length += bytes.len() as u64;
        Ok(())
    }

    fn cut(&mut self, length: u64) -> Result<()> {
        if length > self.length {
            let (path, is) = (self.path.display(), self.length);
            return Err(Error::Failed(format!("{path} has {is} bytes, and had {length} when the checkpoint was made")));
        }
        self.file.set_len(length).map_err(Error::write(&self.path))?;
        self.length = length;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_added_taken_back_and_gone_on_with() {
        let folder = tempfile::tempdir().unwrap();
        let run = Run::create(Some(&folder.path().join("run")), "x").unwrap();
        let row = |steps| LogRow { wall: SystemTime::UNIX_EPOCH, steps, values: vec![("a".into(), 0.5)] };
        let text = || std::fs::read_to_string(run.folder.join(metrics::METRICS)).unwrap();
        let mut logs = LiveLogs::open(&run).unwrap();
        logs.append(&row(1)).unwrap();
        let one = logs.lengths();
        logs.append(&row(2)).unwrap();
        assert_eq!(text(), "steps,a\n1,0.5\n2,0.5\n");
        logs.cut(one).unwrap();
        drop(logs);
        // A kill in the middle of a row.
        File::options().append(true).open(run.folder.join(metrics::METRICS)).unwrap().write_all(b"2,0.").unwrap();
        let mut logs = LiveLogs::open(&run).unwrap();
        logs.cut(one).unwrap();
        assert_eq!(logs.lengths(), one);
        logs.append(&row(3)).unwrap();
        assert_eq!(text(), "steps,a\n1,0.5\n3,0.5\n");
        assert!(logs.cut(LogLengths { metrics: 1000, events: 0 }).unwrap_err().to_string().contains("1000"));
        assert_eq!(std::fs::read_dir(run.folder.join(TENSORBOARD)).unwrap().count(), 1);
    }
}
