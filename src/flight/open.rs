//! A flight log from a file of any kind that racer reads.

mod choose;

use super::mapping::Mapping;
use super::table::Tables;
use super::{Log, blackbox, csv, mcap, ulog};
use crate::base::check::BadInput;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

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
}

/// Reads a log with the named mapping, or the format's own.
pub fn open(path: &Path, mapping: Option<&str>) -> Result<Log, BadInput> {
    Ok(open_with(path, Options { mapping, flight: None })?.log)
}

/// Reads a log, and says how.
pub fn open_with(path: &Path, options: Options) -> Result<Opened, BadInput> {
    let name = path.display().to_string();
    let bytes = read(path)?;
    let format = Format::of(&bytes, &name)?;
    if options.flight.is_some() && format != Format::Blackbox {
        let found = format!("a file of another kind, {name}");
        return Err(BadInput::new("--flight", found, "a blackbox file, which may hold several", "leave it out"));
    }
    let mut remarks = Vec::new();
    let (mapping, called) = match (options.mapping, format) {
        (Some(called), _) => (Mapping::load(called)?, called.to_string()),
        (None, Format::Csv) => {
            let called = choose::for_columns(&csv::header(&bytes, &name)?, &name)?;
            remarks.push(format!("its columns fit the built-in mapping `{called}`"));
            (Mapping::built_in(called)?, called.to_string())
        }
        (None, Format::Blackbox) => (Mapping::built_in("betaflight")?, "betaflight".into()),
        (None, Format::ULog) => (Mapping::built_in("px4")?, "px4".into()),
        (None, Format::Mcap) => (Mapping::built_in("canonical")?, "canonical".into()),
    };
    let mut tables = match format {
        Format::Csv => csv_tables(path, &bytes, &name, &mapping)?,
        Format::Blackbox => {
            let (tables, chosen) = blackbox::tables(&bytes, &name, &mapping.columns(), options.flight)?;
            remarks.extend(chosen);
            tables
        }
        Format::ULog => ulog::tables(&bytes, &name, &|topic| mapping.wanted(topic))?,
        Format::Mcap => mcap::tables(&bytes, &|topic| mapping.wanted(topic))
            .map_err(|error| BadInput { place: format!("{name}, {}", error.place), ..error })?,
    };
    let mut log = mapping.apply(&tables, &name);
    if log.is_err() && format == Format::Mcap {
        // Again, for a message that names all topics.
        for topic in mcap::topics(&bytes)? {
            tables.tables.entry(topic.name).or_default();
        }
        log = mapping.apply(&tables, &name);
    }
    Ok(Opened { log: log?, mapping: called, remarks })
}

fn read(path: &Path) -> Result<Vec<u8>, BadInput> {
    if path.is_dir() {
        let advice = "name a file in it, such as the .mcap of a rosbag2 recording";
        return Err(BadInput::new(path.display(), "a folder", "a flight log", advice));
    }
    std::fs::read(path).map_err(|error| BadInput::new(path.display(), error, "a flight log", ""))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Mcap,
    Blackbox,
    ULog,
    Csv,
}

impl Format {
    /// What the content looks like, whatever the name.
    fn of(bytes: &[u8], name: &str) -> Result<Self, BadInput> {
        const KINDS: &str = "MCAP, Betaflight blackbox, PX4 ULog, or CSV (also .csv.gz)";
        let refuse = |found: &str, advice: &str| Err(BadInput::new(name, found, KINDS, advice));
        let start = &bytes[..bytes.len().min(4096)];
        let lower = name.to_lowercase();
        let ends = |extensions: &[&str]| extensions.iter().any(|extension| lower.ends_with(extension));
        if bytes.is_empty() {
            refuse("an empty file", "")
        } else if start.starts_with(b"\x89MCAP") {
            Ok(Format::Mcap)
        } else if start.starts_with(b"ULog") {
            Ok(Format::ULog)
        } else if start.windows(18).any(|window| window == b"H Product:Blackbox") || ends(&[".bbl", ".bfl"]) {
            Ok(Format::Blackbox)
        } else if start.starts_with(b"SQLite format 3") {
            refuse("an SQLite database", "convert a rosbag2 recording with `ros2 bag convert` to MCAP")
        } else if start.starts_with(b"#ROSBAG") {
            refuse("a ROS 1 bag", "convert it to MCAP, for example with `mcap convert`")
        } else if start.starts_with(&[0x1f, 0x8b])
            || ends(&[".csv", ".tsv", ".txt"])
            || std::str::from_utf8(start).is_ok()
        {
            Ok(Format::Csv)
        } else {
            refuse("none of them", "")
        }
    }
}

/// The one table of a CSV file, and those of the files beside it that the mapping names.
fn csv_tables(path: &Path, bytes: &[u8], name: &str, mapping: &Mapping) -> Result<Tables, BadInput> {
    let columns = mapping.columns();
    let wanted =
        |table: &str| columns.iter().filter(|(source, _)| *source == table).map(|(_, column)| *column).collect();
    let (table, readable) = csv::table(bytes, name, &wanted(""))?;
    let mut tables = Tables { tables: BTreeMap::from([(String::new(), table)]), readable, ..Tables::default() };
    for source in mapping.sources() {
        if let Some(beside) = beside(path, source) {
            let (table, _) = csv::table(&read(&beside)?, &beside.display().to_string(), &wanted(source))?;
            tables.tables.insert(source.into(), table);
        }
    }
    Ok(tables)
}

/// The file beside a CSV file that a source such as `_gps` stands for, where there is one.
fn beside(path: &Path, source: &str) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let (stem, extension) = [".csv.gz", ".csv"].iter().find_map(|end| Some((name.strip_suffix(end)?, *end)))?;
    let other = if extension == ".csv" { ".csv.gz" } else { ".csv" };
    let file = |extension| path.with_file_name(format!("{stem}{source}{extension}"));
    [extension, other].map(file).into_iter().find(|file| source.starts_with('_') && file.is_file())
}
