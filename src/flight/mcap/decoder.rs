//! From a channel's encodings to the decoder of its messages.

use super::column::Columns;
use super::{cdr, idl, json, msg, protobuf};

/// Larger messages and schemas are not those of a vehicle's measurements; what decodes them would take many times their
/// size.
const BYTES: usize = 1 << 20;

/// A schema record, kept.
#[derive(PartialEq)]
pub struct Schema {
    pub name: String,
    pub encoding: String,
    pub data: Vec<u8>,
}

pub enum Decoder {
    Cdr(cdr::CdrDecoder),
    Json,
    Protobuf(protobuf::Descriptors),
}

impl Decoder {
    /// Decodes messages of this encoding and schema; an error says why that is not possible.
    pub fn new(encoding: &str, schema: Option<&Schema>, columns: &Columns) -> Result<Self, String> {
        if encoding == "json" {
            return Ok(Self::Json);
        }
        let schema = schema.ok_or("its channel has no schema")?;
        if schema.data.len() > BYTES {
            return Err(format!("its schema is larger than {BYTES} bytes"));
        }
        columns.spend(64 * schema.data.len())?;
        let text = || str::from_utf8(&schema.data).map_err(|_| "its schema is not text");
        match (encoding, schema.encoding.as_str()) {
            ("cdr", "ros2msg") => Ok(Self::Cdr(cdr::CdrDecoder::new(msg::schema(&schema.name, text()?)?))),
            ("cdr", "ros2idl") => Ok(Self::Cdr(cdr::CdrDecoder::new(idl::schema(&schema.name, text()?)?))),
            ("protobuf", "protobuf") => Ok(Self::Protobuf(protobuf::Descriptors::new(&schema.name, &schema.data)?)),
            _ => Err("this encoding is not known".into()),
        }
    }

    /// Adds a message to the row being read.
    pub fn decode(&mut self, data: &[u8], columns: &mut Columns) -> Result<(), String> {
        if data.len() > BYTES {
            return Err(format!("a message is larger than {BYTES} bytes"));
        }
        match self {
            Self::Cdr(decoder) => decoder.decode(data, columns),
            Self::Json => json::decode(data, columns),
            Self::Protobuf(schema) => protobuf::decode(schema, data, columns),
        }
    }
}
