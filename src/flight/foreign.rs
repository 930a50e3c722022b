//! Files that are no flight log, and what they are instead.

use super::format::LogFile;
use crate::base::document::{Document, decode};
use crate::model::vehicle::Vehicle;

/// What a file is, and what to do about it.
pub type Foreign = (&'static str, &'static str);

/// Logs that others convert: how they start, what they are, what to do.
const CONVERTED: [(&[u8], &str, &str); 2] = [
    (b"SQLite format 3", "an SQLite database", "convert a rosbag2 recording with `ros2 bag convert` to MCAP"),
    (b"#ROSBAG", "a ROS 1 bag", "convert it to MCAP, for example with `mcap convert`"),
];

const ANOTHER: &str = "give a flight log";

/// Texts by the ends of their names.
const TEXTS: [(&[&str], &str); 4] = [
    (&[".md", ".rst"], "a text to read"),
    (&[".html", ".htm", ".svg"], "a page"),
    (&[".json"], "a JSON file"),
    (&[".yaml", ".yml"], "a YAML file"),
];

/// A larger text is not looked at as a whole.
const MOST_BYTES: usize = 1 << 20;

/// A file that starts as a log of others does, which the user has to convert.
pub fn converted(file: &LogFile) -> Option<Foreign> {
    let start = CONVERTED.iter().find(|(start, ..)| file.bytes.starts_with(start));
    start.map(|(_, found, advice)| (*found, *advice))
}

/// A text that is no table, such as a vehicle file or a page.
pub fn text(file: &LogFile) -> Option<Foreign> {
    let start = String::from_utf8_lossy(file.start()).trim_start().to_lowercase();
    if ["<!doctype", "<html", "<?xml", "<svg"].iter().any(|mark| start.starts_with(mark)) {
        return Some(("a page", ANOTHER));
    }
    if let Some((_, found)) = TEXTS.iter().find(|(ends, _)| file.ends(ends)) {
        return Some((found, ANOTHER));
    }
    toml(file)
}

/// A TOML file, and whether it is a vehicle's. The first line of a CSV file is no TOML.
fn toml(file: &LogFile) -> Option<Foreign> {
    let text = std::str::from_utf8(file.bytes).ok().filter(|text| text.len() < MOST_BYTES)?;
    let table = Document::parse(file.name, text).ok().map(|document| document.table().clone());
    match table {
        Some(table) if table.is_empty() => None,
        Some(table) if decode::<Vehicle>(table.clone()).is_ok() => {
            Some(("a vehicle file", "give it with --vehicle, and a flight log in its place"))
        }
        Some(_) => Some(("a TOML file", ANOTHER)),
        None => file.ends(&[".toml"]).then_some(("a TOML file, with an error in it", ANOTHER)),
    }
}
