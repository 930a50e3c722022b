//! The checkpoints of a training in its run folder: the last two, so that one is whole whatever happens.

use super::live::LogLengths;
use super::{Run, resolved};
use crate::base::check::BadInput;
use crate::base::error::{Error, Result};
use crate::base::fsio;
use crate::race::checkpoint::{self, RaceState};
use crate::race::config::Setup;
use crate::race::env::Race;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// Folder in a run folder; gone when the run is finished.
pub const CHECKPOINTS: &str = "checkpoints";
const ENDING: &str = "checkpoint";
/// Checkpoints kept.
const KEPT: usize = 2;

/// A policy on the way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Taken {
    pub steps: u64,
    pub seconds: f64,
}

/// What belongs to a state besides itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// The files of the configuration, one after the other.
    setup: String,
    pub logs: LogLengths,
    pub taken: Vec<Taken>,
}

/// The folder of the checkpoints, which only one process at a time may have.
#[derive(Debug)]
pub struct Checkpoints {
    folder: PathBuf,
    // Locked as long as it is open.
    _lock: File,
    setup: String,
}

/// What a training goes on from.
#[derive(Debug, Default)]
pub struct ResumePoint {
    pub state: Option<RaceState>,
    pub note: Note,
    /// Of each checkpoint that could not be used: which, and why.
    pub refused: Vec<String>,
}

impl Checkpoints {
    /// Claims the checkpoints of `run`, which is trained as `setup` says.
    pub fn claim(run: &Run, setup: &Setup) -> Result<Self> {
        let folder = run.folder.join(CHECKPOINTS);
        fs::create_dir_all(&folder).map_err(Error::write(&folder))?;
        let path = folder.join("lock");
        let lock = File::options().create(true).truncate(false).write(true).open(&path).map_err(Error::write(&path))?;
        if let Err(TryLockError::WouldBlock) = lock.try_lock() {
            let advice = "wait for it, or end it";
            return Err(BadInput::new(
                run.folder.display(),
                "a run that another process is training",
                "a run that is not being trained",
                advice,
            )
            .into());
        }
        let setup = resolved::files(setup)?.map(|(_, content)| content).concat();
        Ok(Self { folder, _lock: lock, setup })
    }

    /// Keeps a state, and of those before it the last.
    pub fn keep(&self, state: &RaceState, logs: LogLengths, taken: &[Taken]) -> Result<()> {
        let note = Note { setup: self.setup.clone(), logs, taken: taken.into() };
        let note = serde_json::to_string(&note).map_err(Error::encode("the checkpoint"))?;
        let path = self.folder.join(format!("{:013}.{ENDING}", state.steps));
        fsio::replace(&path, &checkpoint::to_bytes(state, &note)?).map_err(Error::write(&path))?;
        let files = files(&self.folder);
        for old in &files[..files.len().saturating_sub(KEPT)] {
            let _ = fs::remove_file(old);
        }
        Ok(())
    }

    /// The youngest state that is whole and that `fits`; none where there is none yet.
    pub fn find(&self, race: &Race, fits: &dyn Fn(&Note) -> Result<(), String>) -> ResumePoint {
        let mut refused = Vec::new();
        for path in files(&self.folder).into_iter().rev() {
            match self.read(&path, race).and_then(|(state, note)| fits(&note).map(|()| (state, note))) {
                Ok((state, note)) => return ResumePoint { state: Some(state), note, refused },
                Err(why) => refused.push(format!("{}: {why}", path.display())),
            }
        }
        ResumePoint { state: None, note: Note::default(), refused }
    }

    fn read(&self, path: &Path, race: &Race) -> Result<(RaceState, Note), String> {
        let bytes = fs::read(path).map_err(|error| error.to_string())?;
        let (state, note) = checkpoint::from_bytes(&bytes, race).map_err(|invalid| invalid.found)?;
        let note: Note = serde_json::from_str(&note).map_err(|error| error.to_string())?;
        let same = note.setup == self.setup;
        if same { Ok((state, note)) } else { Err("made with another configuration, track or vehicle".into()) }
    }

    /// Removes what is younger than `state`: it is made again.
    pub fn forget_after(&self, steps: u64) {
        let younger = |path: &PathBuf| steps_of(path).is_none_or(|of| of > steps);
        files(&self.folder).iter().filter(|path| younger(path)).for_each(|path| drop(fs::remove_file(path)));
    }

    /// Removes them all: the run is finished.
    pub fn remove(self) {
        let Self { folder, _lock, .. } = self;
        // One that stays does no harm.
        let _ = fs::remove_dir_all(&folder);
        // Windows keeps the folder of an open file.
        drop(_lock);
        let _ = fs::remove_dir(&folder);
    }
}

/// All checkpoints, in the order of training.
fn files(folder: &Path) -> Vec<PathBuf> {
    let there = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut all: Vec<_> = there.filter(|path| path.extension().is_some_and(|ending| ending == ENDING)).collect();
    all.sort();
    all
}

fn steps_of(path: &Path) -> Option<u64> {
    path.file_stem()?.to_str()?.parse().ok()
}
