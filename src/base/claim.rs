//! A folder that several processes could want to fill: one does, and the others see it finished or not at all.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The right to fill one folder, and the place where it is filled. Ends with the process, however that ends.
#[derive(Debug)]
pub struct Claim {
    lock: PathBuf,
    // Locked as long as it is open.
    _file: File,
    work: TempDir,
}

impl Claim {
    /// Claims `name` in the folder `at`, which is made if need be, and removes what a killed process has left of it.
    /// `None` where a running process has it. Where the file system knows no locks, nobody has it.
    pub fn take(at: &Path, name: &str) -> io::Result<Option<Self>> {
        fs::create_dir_all(at)?;
        let lock = at.join(format!("{name}.lock"));
        let file = File::options().create(true).truncate(false).write(true).open(&lock)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(error),
        }
        let prefix = format!("{name}.work-");
        for entry in fs::read_dir(at)?.flatten() {
            if entry.file_name().to_string_lossy().starts_with(&prefix) {
                // One that a dying process still writes to goes next time.
                let _ = fs::remove_dir_all(entry.path());
            }
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix);
        // Temporary folders are private by default; this one becomes an ordinary one.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let work = builder.tempdir_in(at)?;
        Ok(Some(Self { lock, _file: file, work }))
    }

    /// Where it is filled.
    pub fn work(&self) -> &Path {
        self.work.path()
    }

    /// Makes it the folder `to`, all at once. Fails where that has come to hold something in the meantime.
    pub fn publish(self, to: &Path) -> io::Result<()> {
        fs::rename(self.work.path(), to)
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // What remains of the work goes with `work`. A process that opened the file before it went away finds a lock,
        // too, and then a folder that is finished.
        let _ = fs::remove_file(&self.lock);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_process_fills_it_and_leftovers_go() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path().join("work");
        fs::create_dir_all(at.join("a.work-old")).unwrap();
        fs::write(at.join("a.work-old/half"), "").unwrap();
        let first = Claim::take(&at, "a").unwrap().unwrap();
        assert!(!at.join("a.work-old").exists());
        assert!(Claim::take(&at, "a").unwrap().is_none());
        assert!(Claim::take(&at, "b").unwrap().is_some());
        fs::write(first.work().join("whole"), "1").unwrap();
        let to = folder.path().join("a");
        first.publish(&to).unwrap();
        assert_eq!(fs::read(to.join("whole")).unwrap(), b"1");
        let second = Claim::take(&at, "a").unwrap().unwrap();
        fs::write(second.work().join("whole"), "2").unwrap();
        assert!(second.publish(&to).is_err());
        assert_eq!(fs::read(to.join("whole")).unwrap(), b"1");
        assert_eq!(fs::read_dir(&at).unwrap().count(), 0, "nothing is left behind");
    }
}
