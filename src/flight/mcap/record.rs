//! The records of an MCAP file that matter here, as <https://mcap.dev/spec> lays them out.
//!
//! The `mcap` crate writes files but does not read them here: on hostile lengths it panics, or allocates what they ask
//! for.

use super::bytes::Bytes;
use ::mcap::records::op;

/// One record, borrowed from the file or from a decompressed chunk.
pub enum McapRecord<'a> {
    Schema(SchemaRecord<'a>),
    Channel(ChannelRecord<'a>),
    Message(MessageRecord<'a>),
    /// The values: keys and values, each after its length.
    Metadata {
        name: &'a str,
        values: &'a [u8],
    },
    /// A record that says nothing about messages.
    Other,
}

pub struct SchemaRecord<'a> {
    pub id: u16,
    pub name: &'a str,
    pub encoding: &'a str,
    pub data: &'a [u8],
}

pub struct ChannelRecord<'a> {
    pub id: u16,
    pub schema: u16,
    pub topic: &'a str,
    pub encoding: &'a str,
}

pub struct MessageRecord<'a> {
    pub channel: u16,
    pub log_time_ns: u64,
    pub data: &'a [u8],
}

impl<'a> McapRecord<'a> {
    /// The record with this opcode and body; none where the body does not hold what the opcode asks for.
    pub fn parse(opcode: u8, body: &'a [u8]) -> Option<Self> {
        let b = &mut Bytes(body);
        Some(match opcode {
            op::SCHEMA => {
                Self::Schema(SchemaRecord { id: b.u16()?, name: b.text()?, encoding: b.text()?, data: b.block()? })
            }
            op::CHANNEL => {
                Self::Channel(ChannelRecord { id: b.u16()?, schema: b.u16()?, topic: b.text()?, encoding: b.text()? })
            }
            op::MESSAGE => {
                let (channel, _sequence, log_time_ns, _publish_time) = (b.u16()?, b.u32()?, b.u64()?, b.u64()?);
                Self::Message(MessageRecord { channel, log_time_ns, data: b.0 })
            }
            op::METADATA => Self::Metadata { name: b.text()?, values: b.block()? },
            _ => Self::Other,
        })
    }
}

/// A record's opcode and body, taken from the front of `bytes`.
pub fn next<'a>(bytes: &mut Bytes<'a>) -> Option<(u8, &'a [u8])> {
    let mut ahead = *bytes;
    let (opcode, length) = (ahead.u8()?, ahead.u64()?);
    let body = ahead.take(usize::try_from(length).ok()?)?;
    *bytes = ahead;
    Some((opcode, body))
}
