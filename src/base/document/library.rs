//! Files that are found by name: in the working directory, in their folder, or built into the program.

use super::{Document, nearest};
use crate::base::check::BadInput;
use std::path::{Path, PathBuf};

/// A kind of file, the folder it is kept in, and those that every copy of the program carries.
pub struct Library {
    /// What one of them is called in messages, such as `track`.
    pub kind: &'static str,
    /// Folder below the working directory.
    pub folder: &'static str,
    /// Name without `.toml`, and text.
    pub builtin: &'static [(&'static str, &'static str)],
}

impl Library {
    /// Opens `name`, a path or a bare name, with or without `.toml`. The first found counts: the path itself, the same
    /// in the folder, then the built-in one. Fails where there is none, or where it is not TOML.
    pub fn open(&self, name: &str) -> Result<Document, BadInput> {
        if let Some(path) = self.paths(name).into_iter().find(|path| path.is_file()) {
            return Document::read(&path);
        }
        self.built_in(name)
    }

    /// The built-in one of that name, whatever files there are.
    pub fn built_in(&self, name: &str) -> Result<Document, BadInput> {
        let stem = name.strip_suffix(".toml").unwrap_or(name);
        match self.builtin.iter().find(|(known, _)| *known == stem) {
            Some((known, text)) => Document::parse(format!("{known}.toml (built in)"), *text),
            None => Err(self.missing(name)),
        }
    }

    fn paths(&self, name: &str) -> Vec<PathBuf> {
        let mut paths = Vec::new();
        for folder in [Path::new(""), Path::new(self.folder)] {
            paths.push(folder.join(name));
            if !name.ends_with(".toml") {
                paths.push(folder.join(format!("{name}.toml")));
            }
        }
        paths
    }

    fn missing(&self, name: &str) -> BadInput {
        let known: Vec<_> = self.builtin.iter().map(|(known, _)| *known).collect();
        let advice = match nearest(name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`? Built in are {}", known.join(", ")),
            None => format!("name a file, or one of the built-in {}", known.join(", ")),
        };
        let looked = format!("no such file here, in {}/, or built in", self.folder);
        BadInput::new(format!("{} `{name}`", self.kind), looked, &format!("a {} file or name", self.kind), advice)
    }
}
