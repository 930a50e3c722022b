//! The wire format of protobuf.

use crate::flight::mcap::bytes::Bytes;
use std::collections::HashMap;

/// A value as it is transmitted.
#[derive(Clone, Copy)]
pub enum Wire<'a> {
    /// The bits of a number.
    Number(u64),
    /// A message, a string, or packed numbers.
    Bytes(&'a [u8]),
}

impl Wire<'_> {
    /// The bits of a number; 0 for anything else.
    pub fn bits(&self) -> u64 {
        match self {
            Self::Number(bits) => *bits,
            Self::Bytes(_) => 0,
        }
    }
}

/// How the bits of a number are meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WireNumber {
    Bool,
    Signed,
    Unsigned,
    /// Signed, with the sign in the lowest bit.
    Zigzag,
    Fixed32,
    Fixed64,
    Sfixed32,
    Sfixed64,
    Float,
    Double,
}

impl WireNumber {
    pub fn value(self, bits: u64) -> f64 {
        match self {
            Self::Bool => f64::from(bits != 0),
            Self::Signed | Self::Sfixed64 => bits as i64 as f64,
            Self::Unsigned | Self::Fixed32 | Self::Fixed64 => bits as f64,
            Self::Zigzag => ((bits >> 1) as i64 ^ -((bits & 1) as i64)) as f64,
            Self::Sfixed32 => f64::from(bits as i32),
            Self::Float => f64::from(f32::from_bits(bits as u32)),
            Self::Double => f64::from_bits(bits),
        }
    }

    /// The elements of a packed list.
    pub fn unpack<'a>(self, packed: &[u8]) -> Option<Vec<Wire<'a>>> {
        let mut rest = Bytes(packed);
        let mut elements = Vec::new();
        while !rest.0.is_empty() {
            elements.push(Wire::Number(match self {
                Self::Fixed32 | Self::Sfixed32 | Self::Float => rest.u32()?.into(),
                Self::Fixed64 | Self::Sfixed64 | Self::Double => rest.u64()?,
                Self::Bool | Self::Signed | Self::Unsigned | Self::Zigzag => varint(&mut rest)?,
            }));
        }
        Some(elements)
    }
}

/// The values of a message by field number, in their order. None where the bytes are no message.
pub fn values(message: &[u8]) -> Option<HashMap<u32, Vec<Wire<'_>>>> {
    let mut rest = Bytes(message);
    let mut values: HashMap<u32, Vec<Wire>> = HashMap::new();
    // Groups are an outdated form of messages; what they hold is skipped.
    let mut groups = 0_usize;
    while !rest.0.is_empty() {
        let tag = u32::try_from(varint(&mut rest)?).ok()?;
        let value = match tag & 7 {
            0 => Wire::Number(varint(&mut rest)?),
            1 => Wire::Number(rest.u64()?),
            2 => {
                let length = varint(&mut rest)?;
                Wire::Bytes(rest.take(usize::try_from(length).ok()?)?)
            }
            3 => {
                groups += 1;
                continue;
            }
            4 => {
                groups = groups.checked_sub(1)?;
                continue;
            }
            5 => Wire::Number(rest.u32()?.into()),
            _ => return None,
        };
        if groups == 0 {
            values.entry(tag >> 3).or_default().push(value);
        }
    }
    (groups == 0).then_some(values)
}

fn varint(rest: &mut Bytes) -> Option<u64> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let byte = rest.u8()?;
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some(number);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_what_their_type_says() {
        assert_eq!(WireNumber::Zigzag.value(3), -2.0);
        assert_eq!(WireNumber::Signed.value(u64::MAX), -1.0);
        assert_eq!(WireNumber::Sfixed32.value(0xffff_fffe), -2.0);
        assert_eq!(varint(&mut Bytes(&[0xac, 0x02])), Some(300));
        assert_eq!(varint(&mut Bytes(&[0xff; 10])), None);
    }

    #[test]
    fn groups_are_skipped() {
        let message = [8, 1, 0x13, 8, 2, 0x14, 8, 3];
        let values = values(&message).unwrap();
        assert_eq!(values[&1].iter().map(Wire::bits).collect::<Vec<_>>(), [1, 3]);
        assert!(super::values(&message[..5]).is_none());
    }
}
