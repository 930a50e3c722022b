//! Writing files: whole or not at all, and never over what exists, unless the program keeps it up to date itself.

use crate::base::check::BadInput;
use crate::base::error::{Error, Result};
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use tempfile::NamedTempFile;

/// What temporary files' names begin with.
const PREFIX: &str = ".racer-";

/// A file to be written later, whose folder is known to take it. Nothing is left behind where it is never written.
#[derive(Debug)]
pub struct Reserved {
    file: Temporary,
    path: PathBuf,
    /// Whether another name is as good.
    numbered: bool,
}

impl Reserved {
    /// Makes sure that `path`, which `option` was given, does not exist and that its folder can be written to.
    pub fn new(path: &Path, option: &str) -> Result<Self, BadInput> {
        if path.exists() {
            let advice = format!("choose another path ({option}); nothing existing is overwritten");
            return Err(BadInput::new(path.display(), "a file that exists", "a path to a new file", advice));
        }
        match Temporary::new(folder_of(path)) {
            Ok(file) => Ok(Self { file, path: path.into(), numbered: false }),
            Err(error) => Err(BadInput::new(
                path.display(),
                error,
                "a folder that can be written to",
                format!("choose another path ({option})"),
            )),
        }
    }

    /// The same for `path`, or the first of `path-2`, `path-3` ... that does not exist when it is written.
    pub fn numbered(path: &Path, option: &str) -> Result<Self, BadInput> {
        Ok(Self { numbered: true, ..Self::new(&free(path), option)? })
    }

    /// Writes the file, all at once. Fails if it has come to exist in the meantime.
    pub fn write(mut self, bytes: &[u8]) -> Result<PathBuf> {
        let failed = Error::write(&self.path);
        if let Err(error) = self.file.fill(bytes) {
            return Err(failed(error));
        }
        loop {
            match self.file.persist_new(&self.path) {
                Ok(()) => return Ok(self.path),
                Err((file, error)) if self.numbered && error.kind() == io::ErrorKind::AlreadyExists => {
                    (self.file, self.path) = (file, free(&self.path));
                }
                Err((_, error)) => return Err(failed(error)),
            }
        }
    }
}

/// `path`, or the first of `path-2`, `path-3` ... that does not exist.
pub fn free(path: &Path) -> PathBuf {
    let numbered = |number: usize| {
        let mut name = path.file_stem().unwrap_or_default().to_os_string();
        name.push(format!("-{number}"));
        if let Some(extension) = path.extension() {
            name.push(".");
            name.push(extension);
        }
        path.with_file_name(name)
    };
    std::iter::once(path.to_path_buf()).chain((2..).map(numbered)).find(|path| !path.exists()).unwrap_or_default()
}

/// Writes a new file, all at once. Fails if it exists. Survives a loss of power.
pub fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = Temporary::new(folder_of(path))?;
    file.fill(bytes)?;
    file.persist_new(path).map_err(|(_, error)| error)
}

/// Writes a file that the program keeps up to date, all at once, in place of the one it wrote before. Survives a loss
/// of power.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = Temporary::new(folder_of(path))?;
    file.fill(bytes)?;
    file.persist(path)
}

/// Removes the temporary files that killed processes have left in `folder`, which no other process writes to.
pub fn remove_leftovers(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(PREFIX) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Removes the temporary files of this process, which is about to end without returning to whoever made them.
pub fn remove_temporaries() {
    let Ok(open) = OPEN.lock() else { return };
    open.iter().for_each(|path| drop(std::fs::remove_file(path)));
}

/// Temporary files of this process.
static OPEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A file on its way to another name; goes where it does not get there.
#[derive(Debug)]
struct Temporary(Option<NamedTempFile>);

impl Temporary {
    fn new(folder: &Path) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX);
        // Temporary files are private by default; these become ordinary ones.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        // Made and known under one lock: a signal that comes in between waits for it.
        let mut open = OPEN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let file = builder.tempfile_in(folder).map_err(plain)?;
        open.insert(file.path().into());
        Ok(Self(Some(file)))
    }

    /// Writes all of `bytes`, to the disk itself.
    fn fill(&mut self, bytes: &[u8]) -> io::Result<()> {
        let Some(file) = &mut self.0 else { return Ok(()) };
        file.as_file_mut().write_all(bytes)?;
        file.as_file().sync_all()
    }

    fn persist(mut self, path: &Path) -> io::Result<()> {
        let Some(file) = self.0.take() else { return Ok(()) };
        let name = file.path().to_path_buf();
        let done = file.persist(path).map_err(|error| plain(error.error));
        forget(&name);
        done?;
        sync_folder(path);
        Ok(())
    }

    /// Under a name that nothing else has; otherwise given back.
    fn persist_new(&mut self, path: &Path) -> Result<(), (Self, io::Error)> {
        let Some(file) = self.0.take() else { return Ok(()) };
        let name = file.path().to_path_buf();
        match file.persist_noclobber(path) {
            Ok(_) => {
                forget(&name);
                sync_folder(path);
                Ok(())
            }
            Err(error) => Err((Self(Some(error.file)), plain(error.error))),
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(file) = self.0.take() {
            let name = file.path().to_path_buf();
            drop(file);
            forget(&name);
        }
    }
}

fn forget(name: &Path) {
    OPEN.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).remove(name);
}

/// The new name survives a loss of power, too. Some systems cannot promise it.
fn sync_folder(path: &Path) {
    if cfg!(unix) {
        let _ = std::fs::File::open(folder_of(path)).and_then(|folder| folder.sync_all());
    }
}

/// What the system said, without the name of a temporary file that means nothing to anybody.
fn plain(error: io::Error) -> io::Error {
    let inner = error.get_ref().and_then(|wrapped| wrapped.source()?.downcast_ref::<io::Error>());
    inner.and_then(io::Error::raw_os_error).map_or(error, io::Error::from_raw_os_error)
}

/// A folder of this name, which `option` was given, that is new, or empty, and can be written to. Makes those above it
/// as well.
pub fn new_folder(path: &Path, option: &str) -> Result<(), BadInput> {
    let another = format!("choose another path ({option})");
    let refuse = |found: String, advice: &str| {
        Err(BadInput::new(path.display(), found, "a folder that is new or empty and can be written to", advice))
    };
    if let Err(error) = std::fs::create_dir_all(path) {
        return refuse(error.to_string(), &another);
    }
    match std::fs::read_dir(path).map(|mut entries| entries.next().is_some()) {
        Ok(false) => {}
        Ok(true) => {
            let advice = format!("{another}; nothing existing is overwritten");
            return refuse("a folder with files in it".into(), &advice);
        }
        Err(error) => return refuse(error.to_string(), &another),
    }
    match Temporary::new(path) {
        Ok(_) => Ok(()),
        Err(error) => refuse(error.to_string(), &another),
    }
}

/// A path that two names of one file share, also of a file that does not exist yet.
pub fn real(path: &Path) -> PathBuf {
    let folder = folder_of(path);
    let folder = folder.canonicalize().or_else(|_| std::path::absolute(folder)).unwrap_or_else(|_| folder.into());
    path.file_name().map_or(folder.clone(), |name| folder.join(name))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
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
        assert!(Reserved::new(&path, "--out").unwrap_err().to_string().contains("nothing existing is overwritten"));
        assert_eq!(std::fs::read(&path).unwrap(), b"first");
        let later = Reserved::new(&folder.path().join("b"), "--out").unwrap();
        write_new(&folder.path().join("b"), b"in the meantime").unwrap();
        assert!(later.write(b"late").is_err());
        assert!(new_folder(folder.path(), "--out").unwrap_err().to_string().contains("files in it"));
    }

    #[test]
    fn a_reservation_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        drop(Reserved::new(&folder.path().join("a"), "--out").unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        let open = Reserved::new(&folder.path().join("a"), "--out").unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        // Windows removes no file that is open.
        if cfg!(unix) {
            remove_leftovers(folder.path());
            assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        }
        drop(open);
        assert!(new_folder(&folder.path().join("x/y"), "--out").is_ok());
        assert!(Reserved::new(&folder.path().join("none/a"), "--out").is_err());
    }

    #[test]
    fn several_that_want_one_name_get_one_each() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("e.json");
        let reserved: Vec<_> = (0..4).map(|_| Reserved::numbered(&path, "--out").unwrap()).collect();
        let names: Vec<_> = reserved.into_iter().map(|r| r.write(b"x").unwrap()).collect();
        let names: Vec<_> = names.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["e.json", "e-2.json", "e-3.json", "e-4.json"]);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4);
    }

    // Elsewhere the folder of an open file stays.
    #[cfg(unix)]
    #[test]
    fn failures_name_what_was_to_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let to = folder.path().join("gone");
        std::fs::create_dir(&to).unwrap();
        let reserved = Reserved::new(&to.join("a.json"), "--out").unwrap();
        std::fs::remove_dir_all(&to).unwrap();
        let text = reserved.write(b"x").unwrap_err().to_string();
        assert!(text.contains("a.json") && !text.contains(PREFIX), "{text}");
    }
}
