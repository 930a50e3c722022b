//! The one error of the library.

use crate::base::check::BadInput;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// Why something could not be done. The text says what was expected, what was found, where, and what to do about it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Input that cannot be used: a file, a key in it, or an argument. Nothing was started.
    #[error(transparent)]
    BadInput(#[from] BadInput),
    /// A file could not be written.
    #[error("{} could not be written: {why}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        why: io::Error,
    },
    /// Something has no place in the format it was to be written in.
    #[error("{what} could not be written: {why}")]
    Encode {
        /// What was to be written.
        what: &'static str,
        /// Why it could not be.
        why: String,
    },
    /// A figure could not be drawn.
    #[error("a figure could not be drawn: {0}")]
    Draw(String),
    /// Work ended without a result.
    #[error("{0}")]
    Failed(String),
    /// Whoever watches asked to stop before there was a result. The text says what there is so far.
    #[error("{0}")]
    Interrupted(String),
}

/// What can fail, with the library's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// The error of writing to `path`.
    pub fn write(path: &Path) -> impl FnOnce(io::Error) -> Self + use<> {
        let path = path.to_path_buf();
        move |why| Error::Write { path, why }
    }

    /// The error of encoding `what`, whatever the encoder calls it.
    pub fn encode<E: Display>(what: &'static str) -> impl Fn(E) -> Self {
        move |error| Error::Encode { what, why: error.to_string() }
    }
}
