//! The training log as a TensorBoard event file.
//!
//! The format is small: a chain of records (length, checksum, data, checksum), each a protocol buffer `Event`. The
//! crates that write it bring a protocol-buffer compiler or a tensor library along, or are no longer kept up.

use super::metrics::LogRow;
use std::time::{SystemTime, UNIX_EPOCH};

/// Name of the file, as TensorBoard looks for it.
pub fn file_name(started: SystemTime) -> String {
    format!("events.out.tfevents.{:.0}.racer", seconds(started))
}

/// What a file begins with.
pub fn version(started: SystemTime) -> Vec<u8> {
    let mut version = double(1, seconds(started));
    version.extend(bytes(3, b"brain.Event:2"));
    record(&version)
}

/// A row as an event. Values that are not finite are left out.
pub fn event(row: &LogRow) -> Vec<u8> {
    let mut summary = Vec::new();
    for (tag, value) in row.values.iter().filter(|(_, value)| value.is_finite()) {
        let mut entry = bytes(1, tag.as_bytes());
        entry.extend(float(2, *value as f32));
        summary.extend(bytes(1, &entry));
    }
    let mut event = double(1, seconds(row.wall));
    event.extend(integer(2, row.steps));
    event.extend(bytes(5, &summary));
    record(&event)
}

fn seconds(time: SystemTime) -> f64 {
    time.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64()
}

/// A record of the TFRecord format.
fn record(data: &[u8]) -> Vec<u8> {
    let length = (data.len() as u64).to_le_bytes();
    let mut file = length.to_vec();
    file.extend(masked(&length).to_le_bytes());
    file.extend(data);
    file.extend(masked(data).to_le_bytes());
    file
}

/// The format's checksum: CRC-32C, rotated and offset so that checksums of checksums stay sound.
fn masked(data: &[u8]) -> u32 {
    crc32c::crc32c(data).rotate_right(15).wrapping_add(0xa282_ead8)
}

/// Wire types of protocol buffers.
const VARINT: u64 = 0;
const FIXED_64: u64 = 1;
const BYTES: u64 = 2;
const FIXED_32: u64 = 5;

fn varint(mut value: u64) -> Vec<u8> {
    let mut out = Vec::new();
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
    out
}

fn field(number: u64, wire: u64, content: impl IntoIterator<Item = u8>) -> Vec<u8> {
    let mut out = varint(number << 3 | wire);
    out.extend(content);
    out
}

fn integer(number: u64, value: u64) -> Vec<u8> {
    field(number, VARINT, varint(value))
}

fn double(number: u64, value: f64) -> Vec<u8> {
    field(number, FIXED_64, value.to_le_bytes())
}

fn float(number: u64, value: f32) -> Vec<u8> {
    field(number, FIXED_32, value.to_le_bytes())
}

fn bytes(number: u64, value: &[u8]) -> Vec<u8> {
    field(number, BYTES, varint(value.len() as u64).into_iter().chain(value.iter().copied()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_carry_length_and_checksums() {
        let file = record(b"123456789");
        assert_eq!(file.len(), 8 + 4 + 9 + 4);
        // CRC-32C of "123456789" is 0xe3069283, the check value of its definition.
        let expected = 0xe306_9283_u32.rotate_right(15).wrapping_add(0xa282_ead8);
        assert_eq!(file[21..], expected.to_le_bytes());
    }

    #[test]
    fn fields_are_encoded_as_the_format_says() {
        assert_eq!(integer(2, 300), [0x10, 0xac, 0x02]);
        assert_eq!(bytes(1, b"ab"), [0x0a, 2, b'a', b'b']);
        assert_eq!(float(2, 1.0), [0x15, 0, 0, 0x80, 0x3f]);
        assert_eq!(double(1, 1.0), [0x09, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f]);
    }

    #[test]
    fn values_that_are_not_finite_are_left_out() {
        let row = |value| LogRow { wall: UNIX_EPOCH, steps: 1, values: vec![("tag".into(), value)] };
        let holds = |value| event(&row(value)).windows(3).any(|window| window == b"tag");
        assert!(holds(1.0) && !holds(f64::NAN));
    }
}
