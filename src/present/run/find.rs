//! Finding a policy to evaluate, or a run: a run folder, a snapshot, or the latest run.

use super::{CONFIG, POLICY, RUNS, SNAPSHOTS};
use crate::base::check::BadInput;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What stands for the youngest run.
const LATEST: &str = "latest";
const EXPECTED: &str = "a run folder, a snapshot (.safetensors), or `latest`";

/// A policy, and the run folder it belongs to where it was named by its run.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundPolicy {
    pub snapshot: PathBuf,
    pub run: Option<PathBuf>,
}

/// The policy that `name` means: of a run its best, or the last on the way where none was chosen. `latest` is the
/// youngest run below `runs/`.
pub fn find(name: &str) -> Result<FoundPolicy, BadInput> {
    let path = match name {
        LATEST => latest(Path::new(RUNS), |run| best(run).is_some(), "with a policy")?,
        _ => PathBuf::from(name),
    };
    if path.is_file() {
        return Ok(FoundPolicy { snapshot: path, run: None });
    }
    if !path.is_dir() {
        return Err(BadInput::new(name, "nothing of that name", EXPECTED, "`racer train` makes one"));
    }
    match best(&path) {
        Some(snapshot) => Ok(FoundPolicy { snapshot, run: Some(path) }),
        None => {
            let found = format!("a folder with neither {POLICY} nor {SNAPSHOTS}/*.safetensors");
            Err(BadInput::new(path.display(), found, EXPECTED, "was the training ended before its first snapshot?"))
        }
    }
}

fn best(run: &Path) -> Option<PathBuf> {
    let policy = run.join(POLICY);
    if policy.is_file() {
        return Some(policy);
    }
    // Names hold the steps with leading zeros, so that the last name is the last policy.
    let snapshots = entries(&run.join(SNAPSHOTS));
    snapshots.into_iter().filter(|path| path.extension().is_some_and(|ext| ext == "safetensors")).max()
}

/// The folder that `name` means: `latest` is that of the youngest run below `runs/`, with a policy or without.
pub fn folder(name: &Path) -> Result<PathBuf, BadInput> {
    if name == Path::new(LATEST) { latest(Path::new(RUNS), |_| true, "at all") } else { Ok(name.into()) }
}

/// The youngest of the `runs` that will do, which are those `called`.
fn latest(runs: &Path, will_do: impl Fn(&Path) -> bool, called: &str) -> Result<PathBuf, BadInput> {
    let age = |run: &PathBuf| {
        let modified = std::fs::metadata(run.join(CONFIG)).and_then(|file| file.modified());
        // Runs of the same second are told apart by name.
        (modified.unwrap_or(SystemTime::UNIX_EPOCH), run.clone())
    };
    let found = entries(runs).into_iter().filter(|run| run.join(CONFIG).is_file() && will_do(run)).max_by_key(age);
    found.ok_or_else(|| {
        let found = format!("no run {called} below {}/", runs.display());
        BadInput::new(LATEST, found, "at least one", "name the run folder, or train first")
    })
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_policy_or_the_last_on_the_way() {
        let folder = tempfile::tempdir().unwrap();
        let run = folder.path().join("run");
        std::fs::create_dir_all(run.join(SNAPSHOTS)).unwrap();
        assert!(find(run.to_str().unwrap()).unwrap_err().to_string().contains("neither"));
        let with_policy = || latest(folder.path(), |run| best(run).is_some(), "with a policy");
        let any = || latest(folder.path(), |_| true, "at all");
        assert!(with_policy().is_err() && any().unwrap_err().to_string().contains("no run at all"));
        std::fs::write(run.join(CONFIG), "").unwrap();
        assert!(with_policy().is_err());
        assert_eq!(any().unwrap(), run);
        for name in ["000002.safetensors", "000010.safetensors", "notes.txt"] {
            std::fs::write(run.join(SNAPSHOTS).join(name), "").unwrap();
        }
        assert_eq!(best(&run).unwrap().file_name().unwrap(), "000010.safetensors");
        std::fs::write(run.join(POLICY), "").unwrap();
        assert_eq!(best(&run), Some(run.join(POLICY)));
        assert_eq!(with_policy().unwrap(), run);
        assert!(find("no such run").is_err());
    }
}
