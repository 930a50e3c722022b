//! TOML files in: found by name, decoded, and every error traced to its file, line and key.

mod decode;
mod library;
mod nearest;
mod place;

pub use decode::decode;
pub use library::Library;
pub use nearest::nearest;

use crate::base::check::{BadInput, Check, Invalid};
use serde::de::DeserializeOwned;
use std::path::Path;

/// A TOML text that parses, and the name to report it under.
#[derive(Clone, Debug)]
pub struct Document {
    /// Path of the file, or the name of one built into the program.
    pub label: String,
    text: String,
    table: toml::Table,
}

impl Document {
    /// Parses `text`. Fails on bad TOML syntax, with the line.
    pub fn parse(label: impl Into<String>, text: impl Into<String>) -> Result<Self, BadInput> {
        let (label, text) = (label.into(), text.into());
        match text.parse::<toml::Table>() {
            Ok(table) => Ok(Self { label, text, table }),
            Err(error) => {
                let line = error.span().map_or(1, |span| place::line_at(&text, span.start));
                let found = text.lines().nth(line - 1).unwrap_or("").trim();
                Err(BadInput::new(format!("{label}:{line}"), format!("`{found}`: {}", error.message()), "TOML", ""))
            }
        }
    }

    /// Reads and parses a file.
    pub fn read(path: &Path) -> Result<Self, BadInput> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| BadInput::new(path.display(), error, "a readable text file", ""))?;
        Self::parse(path.display().to_string(), text)
    }

    /// The file as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The whole content.
    pub fn table(&self) -> &toml::Table {
        &self.table
    }

    /// Whether the file itself sets `key`.
    pub fn sets(&self, key: &str) -> bool {
        place::find(&self.text, key).is_some_and(|found| found.whole)
    }

    /// `file:line` of `key`, or of the innermost table around it that the file has.
    pub fn place_of(&self, key: &str) -> String {
        match place::find(&self.text, key) {
            Some(found) => format!("{}:{}", self.label, found.line),
            None => self.label.clone(),
        }
    }

    /// Names the file and line of a complaint about its content.
    pub fn blame(&self, invalid: Invalid) -> BadInput {
        BadInput::at(self.place_of(&invalid.key), invalid)
    }

    /// Decodes and checks the content.
    pub fn decode<T: DeserializeOwned + Check>(&self) -> Result<T, BadInput> {
        let value: T = decode(self.table.clone()).map_err(|invalid| self.blame(invalid))?;
        value.check().map_err(|invalid| self.blame(invalid))?;
        Ok(value)
    }
}
