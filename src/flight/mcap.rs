//! MCAP files, read through the schemas that they hold.
//!
//! Every number and flag of a message becomes a column named by its path; a time becomes seconds. Nothing in a file
//! makes the reader panic, and what it may allocate is bounded ([`column`], [`chunk`], [`decoder`]).

mod bytes;
mod cdr;
pub(super) mod cdr_input;
mod chunk;
mod column;
mod decoder;
mod file;
mod idl;
mod idl_token;
mod json;
mod msg;
mod protobuf;
mod reader;
mod record;
mod schema;
pub(super) mod vehicle;

use super::format::{Content, Format, LogFile};
use super::mapping::Mapping;
use super::table::Tables;
use crate::base::check::BadInput;
use reader::TopicReader;

/// MCAP files, of racer and of others.
pub struct Mcap;

impl Format for Mcap {
    fn name(&self) -> &'static str {
        "MCAP"
    }

    fn recognises(&self, file: &LogFile) -> bool {
        file.bytes.starts_with(b"\x89MCAP")
    }

    fn mapping(&self, file: &LogFile) -> Result<(&'static str, Option<String>), BadInput> {
        let known = FOREIGN.into_iter().find(|(topics, _)| mentions(file.bytes, topics.as_bytes()));
        Ok(known.map_or(("canonical", None), |(topics, called)| {
            (called, Some(format!("it has topics below {topics}: read with the built-in mapping `{called}`")))
        }))
    }

    fn tables(&self, file: &LogFile, mapping: &Mapping) -> Result<Content, BadInput> {
        let within = |error: BadInput| BadInput { place: format!("{}, {}", file.name, error.place), ..error };
        let wanted = |topic: &str| mapping.wanted(topic);
        let (mut tables, topics) = read(file.bytes, &wanted).map_err(within)?;
        for topic in topics {
            tables.tables.entry(topic.name).or_default();
        }
        Ok(tables.into())
    }
}

/// How the topics of others begin, and the mapping for them.
const FOREIGN: [(&str, &str); 2] = [("/fmu/out/", "px4_ros2"), ("/mavros/", "mavros")];

/// Whether the start or the end of a file, where channels are declared, has this text.
fn mentions(bytes: &[u8], text: &[u8]) -> bool {
    const LOOKED_AT: usize = 1 << 20;
    let start = &bytes[..bytes.len().min(LOOKED_AT)];
    let end = &bytes[bytes.len().saturating_sub(LOOKED_AT)..];
    [start, end].iter().any(|part| part.windows(text.len()).any(|window| window == text))
}

/// A topic of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Topic {
    pub name: String,
    /// Such as `sensor_msgs/msg/Imu`; empty where the file has no schema.
    pub message: String,
    /// Of the messages, and of their schema: `cdr, ros2msg`.
    pub encoding: String,
    /// Messages that could be read.
    pub count: u64,
}

/// The topics for which `wanted` is true, each as a table with the time of logging in `@log_time`.
///
/// A file that breaks off gives what came before. An error if the bytes are no MCAP file, or a wanted topic cannot be
/// decoded.
#[cfg(feature = "internals")]
pub fn tables(bytes: &[u8], wanted: &dyn Fn(&str) -> bool) -> Result<Tables, BadInput> {
    Ok(read(bytes, wanted)?.0)
}

/// The topics of a file, by name, as far as it can be read. An error if the bytes are no MCAP file.
#[cfg(feature = "internals")]
pub fn topics(bytes: &[u8]) -> Result<Vec<Topic>, BadInput> {
    Ok(read(bytes, &|_| false)?.1)
}

/// The tables of the wanted topics, and all topics by name.
fn read(bytes: &[u8], wanted: &dyn Fn(&str) -> bool) -> Result<(Tables, Vec<Topic>), BadInput> {
    let mut reader = TopicReader::new(wanted);
    let readable = file::walk(bytes, &mut |record| reader.record(record))?;
    Ok(reader.finish(readable))
}
