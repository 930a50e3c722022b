//! A flight log from a file of any kind that racer reads.

use super::Log;
use super::blackbox::Blackbox;
use super::blackbox::decoded::Decoded;
use super::csv::files::Csv;
use super::foreign;
use super::format::{Content, FlightSummary, Format, LogFile};
use super::mapping::Mapping;
use super::mcap::Mcap;
use super::ulog::ULog;
use crate::base::check::BadInput;
use std::io::ErrorKind;
use std::path::Path;

/// All formats. The first that recognises a file reads it, and CSV takes any text.
const FORMATS: [&dyn Format; 5] = [&Mcap, &ULog, &Blackbox, &Decoded, &Csv];

/// What to read of a file, and how.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// Name or file of the mapping; the format's own where none is given.
    pub mapping: Option<&'a str>,
    /// Which of several flights in a blackbox file, counted from 1; the longest where none is given.
    pub flight: Option<usize>,
}

/// A log, and how it was read.
#[derive(Clone, Debug)]
pub struct Opened {
    pub log: Log,
    /// Name of the mapping.
    pub mapping: String,
    /// Choices that were made for the user.
    pub remarks: Vec<String>,
    /// All flights of the file, where it has several and none was asked for.
    pub flights: Vec<FlightSummary>,
}

/// Reads a log with the named mapping, or the format's own.
pub fn open(path: &Path, mapping: Option<&str>) -> Result<Log, BadInput> {
    Ok(open_with(path, Options { mapping, flight: None })?.log)
}

/// Reads a log, and says how.
pub fn open_with(path: &Path, options: Options) -> Result<Opened, BadInput> {
    open_bytes(path, &read(path)?, options)
}

/// Reads a log that the file `path` holds as `bytes`.
pub fn open_bytes(path: &Path, bytes: &[u8], options: Options) -> Result<Opened, BadInput> {
    let name = &path.display().to_string();
    let file = LogFile { path, name, bytes, flight: options.flight };
    let format = recognise(&file)?;
    if options.flight.is_some() && !format.has_flights() {
        let found = format!("a file of another kind, {name}");
        return Err(BadInput::new("--flight", found, "a blackbox file, which may hold several", "leave it out"));
    }
    let (mapping, called, chosen) = match options.mapping {
        Some(called) => (Mapping::load(called)?, called, None),
        None => {
            let (called, chosen) = format.mapping(&file)?;
            (Mapping::built_in(called)?, called, chosen)
        }
    };
    let Content { tables, remarks, flights } = format.tables(&file, &mapping)?;
    let log = mapping.apply(&tables, name)?;
    Ok(Opened { log, mapping: called.into(), remarks: chosen.into_iter().chain(remarks).collect(), flights })
}

/// The bytes of a file that may be a log.
fn read(path: &Path) -> Result<Vec<u8>, BadInput> {
    if path.is_dir() {
        let advice = "name a file in it, such as the .mcap of a rosbag2 recording";
        return Err(BadInput::new(path.display(), "a folder", "a flight log", advice));
    }
    std::fs::read(path).map_err(|error| {
        let advice = match error.kind() {
            ErrorKind::NotFound => "is its path spelled right, from the folder that racer is run in?",
            _ => "see that it can be read",
        };
        BadInput::new(path.display(), error, "a flight log", advice)
    })
}

/// The format of a file.
fn recognise(file: &LogFile) -> Result<&'static dyn Format, BadInput> {
    let names = FORMATS.map(|format| format.name()).join(", ");
    let refuse = |found: &str, advice: &str| {
        Err(BadInput::new(file.name, found, &format!("a flight log: one of {names}"), advice))
    };
    if file.bytes.is_empty() {
        return refuse("an empty file", "was it copied whole? Give another");
    }
    if let Some((found, advice)) = foreign::converted(file) {
        return refuse(found, advice);
    }
    // CSV takes any text.
    let [sure @ .., any] = FORMATS;
    if let Some(format) = sure.into_iter().find(|format| format.recognises(file)) {
        return Ok(format);
    }
    match foreign::text(file) {
        Some((found, advice)) => refuse(&format!("{found}, no flight log"), advice),
        None if any.recognises(file) => Ok(any),
        None => refuse("none of them", "convert it to one of them"),
    }
}
