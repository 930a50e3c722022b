//! What a format of log files has to be able to do. A new one is a type that implements [`Format`], and a line in the
//! list of `open.rs`.

use super::mapping::Mapping;
use super::table::Tables;
use crate::base::check::BadInput;
use std::path::Path;

/// A file that is read.
#[derive(Clone, Copy)]
pub struct LogFile<'a> {
    pub path: &'a Path,
    /// What it is called in messages.
    pub name: &'a str,
    pub bytes: &'a [u8],
    /// Which of several flights in it, counted from 1; the format chooses where none is given.
    pub flight: Option<usize>,
}

/// What a file holds, with the choices that were made for the user.
pub struct Content {
    pub tables: Tables,
    pub remarks: Vec<String>,
    /// All flights of the file, where it has several and none was asked for.
    pub flights: Vec<FlightSummary>,
}

/// One of several flights in a file.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct FlightSummary {
    /// Counted from 1: what `--flight` takes.
    pub number: usize,
    /// When it starts, by the clock of the flight controller; none where it cannot be read.
    pub start_s: Option<f64>,
    /// How long it is.
    pub span_s: f64,
    /// What ends it, or why it cannot be read.
    pub end: String,
}

/// A kind of file that holds flights.
pub trait Format: Sync {
    /// What it is called in messages.
    fn name(&self) -> &'static str;

    /// Whether this is such a file, by its content where that can be told, and else by the end of its name.
    fn recognises(&self, file: &LogFile) -> bool;

    /// Name of the built-in mapping for the file, and a remark where others were possible.
    fn mapping(&self, file: &LogFile) -> Result<(&'static str, Option<String>), BadInput>;

    /// Reads what the mapping names; of other tables the name at least, for messages about what is not there. A file
    /// that breaks off, or turns bad, gives what came before.
    fn tables(&self, file: &LogFile, mapping: &Mapping) -> Result<Content, BadInput>;

    /// Whether a file may hold several flights.
    fn has_flights(&self) -> bool {
        false
    }
}

impl<'a> LogFile<'a> {
    /// The bytes by which formats are told apart.
    pub fn start(&self) -> &'a [u8] {
        &self.bytes[..self.bytes.len().min(4096)]
    }

    /// Whether the name ends like this, in capitals or not.
    pub fn ends(&self, extensions: &[&str]) -> bool {
        let name = self.name.to_lowercase();
        extensions.iter().any(|extension| name.ends_with(extension))
    }
}

impl From<Tables> for Content {
    fn from(tables: Tables) -> Self {
        Content { tables, remarks: Vec::new(), flights: Vec::new() }
    }
}
