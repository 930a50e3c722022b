//! Writing files: whole or not at all, and never over what exists, unless the program keeps it up to date itself.

use crate::base::check::BadInput;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A file to be written later, whose folder is known to take it. Nothing is left behind where it is never written.
#[derive(Debug)]
pub struct Reserved {
    file: NamedTempFile,
    path: PathBuf,
}

impl Reserved {
    /// Makes sure that `path` does not exist and that its folder can be written to.
    pub fn new(path: &Path) -> Result<Self, BadInput> {
        if path.exists() {
            let advice = "choose another path (--out); nothing existing is overwritten";
            return Err(BadInput::new(path.display(), "a file that exists", "a path to a new file", advice));
        }
        match temporary(folder_of(path)) {
            Ok(file) => Ok(Self { file, path: path.into() }),
            Err(error) => Err(BadInput::new(
                path.display(),
                error,
                "a folder that can be written to",
                "choose another path (--out)",
            )),
        }
    }

    /// Writes the file, all at once. Fails if it has come to exist in the meantime.
    pub fn write(mut self, bytes: &[u8]) -> io::Result<PathBuf> {
        self.file.write_all(bytes)?;
        self.file.as_file().sync_all()?;
        self.file.persist_noclobber(&self.path).map_err(|error| error.error)?;
        Ok(self.path)
    }
}

/// Writes a new file, all at once. Fails if it exists.
pub fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = temporary(folder_of(path))?;
    file.write_all(bytes)?;
    file.persist_noclobber(path).map_err(|error| error.error)?;
    Ok(())
}

/// Writes a file that the program keeps up to date, all at once, in place of the one it wrote before. Survives a loss
/// of power.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = temporary(folder_of(path))?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// A folder of this name that is new, or empty, and can be written to. Makes those above it as well.
pub fn new_folder(path: &Path) -> Result<(), BadInput> {
    let refuse = |found: String, advice: &str| {
        Err(BadInput::new(path.display(), found, "a folder that is new or empty and can be written to", advice))
    };
    if let Err(error) = std::fs::create_dir_all(path) {
        return refuse(error.to_string(), "choose another path (--out)");
    }
    match std::fs::read_dir(path).map(|mut entries| entries.next().is_some()) {
        Ok(false) => {}
        Ok(true) => {
            return refuse(
                "a folder with files in it".into(),
                "choose another path (--out); nothing existing is overwritten",
            );
        }
        Err(error) => return refuse(error.to_string(), "choose another path (--out)"),
    }
    match temporary(path) {
        Ok(_) => Ok(()),
        Err(error) => refuse(error.to_string(), "choose another path (--out)"),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".racer-");
    // Temporary files are private by default; these become ordinary ones.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_existing_is_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_new(&path, b"first").unwrap();
        assert!(write_new(&path, b"second").is_err());
        assert!(Reserved::new(&path).unwrap_err().to_string().contains("nothing existing is overwritten"));
        assert_eq!(std::fs::read(&path).unwrap(), b"first");
        let later = Reserved::new(&folder.path().join("b")).unwrap();
        write_new(&folder.path().join("b"), b"in the meantime").unwrap();
        assert!(later.write(b"late").is_err());
        assert!(new_folder(folder.path()).unwrap_err().to_string().contains("files in it"));
    }

    #[test]
    fn a_reservation_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        drop(Reserved::new(&folder.path().join("a")).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        assert!(new_folder(&folder.path().join("x/y")).is_ok());
        assert!(Reserved::new(&folder.path().join("none/a")).is_err());
    }
}
