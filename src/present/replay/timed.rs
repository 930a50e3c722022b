//! Messages with times as an MCAP file that Foxglove plots: JSON with schemas.

use super::schema::schema;
use ::mcap::records::MessageHeader;
use ::mcap::{Compression, McapResult, WriteOptions, Writer};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::Cursor;

/// A message of a topic.
pub struct TimedMessage {
    pub ns: u64,
    pub topic: &'static str,
    pub schema: &'static str,
    pub content: Value,
}

impl TimedMessage {
    pub fn new(ns: u64, topic: &'static str, schema: &'static str, content: Value) -> Self {
        TimedMessage { ns, topic, schema, content }
    }
}

/// The bytes of the file.
pub fn write(messages: &[TimedMessage]) -> McapResult<Vec<u8>> {
    let mut file: Writer<Cursor<Vec<u8>>> = WriteOptions::new()
        .library(concat!("racer/", env!("CARGO_PKG_VERSION")))
        .compression(Some(Compression::Zstd))
        .compression_threads(0)
        .create(Cursor::new(Vec::new()))?;
    // A schema describes the first message of every topic that has it.
    let mut examples: BTreeMap<&str, BTreeMap<&str, &Value>> = BTreeMap::new();
    for message in messages {
        examples.entry(message.schema).or_default().entry(message.topic).or_insert(&message.content);
    }
    let mut schemas = BTreeMap::new();
    for (name, examples) in examples {
        let text = schema(name, &examples.into_values().collect::<Vec<_>>()).to_string();
        schemas.insert(name, file.add_schema(name, "jsonschema", text.as_bytes())?);
    }
    let mut channels: BTreeMap<&str, (u16, u32)> = BTreeMap::new();
    for message in messages {
        let (channel_id, sequence) = match channels.get(message.topic) {
            Some(&known) => known,
            None => (file.add_channel(schemas[message.schema], message.topic, "json", &BTreeMap::new())?, 0),
        };
        channels.insert(message.topic, (channel_id, sequence + 1));
        let header = MessageHeader { channel_id, sequence, log_time: message.ns, publish_time: message.ns };
        file.write_to_known_channel(&header, message.content.to_string().as_bytes())?;
    }
    file.finish()?;
    Ok(file.into_inner().into_inner())
}
