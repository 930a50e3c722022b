//! How the values of fields are packed. Some encodings pack several fields that follow each other.
//!
//! The numbers are those of the header lines `Field I encoding`, the same in all firmware that writes data version 2.

use super::bytes::{FrameBytes, extend};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Signed,
    Unsigned,
    /// A number of 14 bits, its sign turned.
    Negative14,
    /// Up to eight fields; a first byte says which of them are not 0.
    Tag8Of8,
    /// Three fields of 2, 4, 6 or each of 8 to 32 bits.
    Tag2Of3,
    /// Four fields, each of 0, 4, 8 or 16 bits, without regard to bytes.
    Tag8Of4,
    Nothing,
    /// Three fields of 2 each, 5 5 4, 8 7 7, or each of 8 to 32 bits.
    Tag2Of3Uneven,
}

impl Encoding {
    pub fn of(number: u32) -> Option<Self> {
        Some(match number {
            0 => Encoding::Signed,
            1 => Encoding::Unsigned,
            3 => Encoding::Negative14,
            6 => Encoding::Tag8Of8,
            7 => Encoding::Tag2Of3,
            8 => Encoding::Tag8Of4,
            9 => Encoding::Nothing,
            10 => Encoding::Tag2Of3Uneven,
            _ => return None,
        })
    }

    /// Whether several fields can share it.
    pub fn groups(self) -> bool {
        matches!(self, Encoding::Tag8Of8 | Encoding::Tag2Of3 | Encoding::Tag8Of4 | Encoding::Tag2Of3Uneven)
    }

    /// Reads one value or a group of them, and says how many. `alike` fields from here on have this encoding.
    pub fn read(self, bytes: &mut FrameBytes, alike: usize, values: &mut [i64; 8]) -> Option<usize> {
        match self {
            Encoding::Signed => values[0] = bytes.signed()?,
            Encoding::Unsigned => values[0] = i64::from(bytes.unsigned()?),
            Encoding::Negative14 => values[0] = -fourteen_bits(bytes.unsigned()?),
            Encoding::Nothing => values[0] = 0,
            Encoding::Tag8Of8 if alike == 1 => values[0] = bytes.signed()?,
            Encoding::Tag8Of8 => {
                let tag = bytes.byte()?;
                for (i, value) in values.iter_mut().enumerate() {
                    *value = if tag >> i & 1 == 1 { bytes.signed()? } else { 0 };
                }
                return Some(alike.min(8));
            }
            Encoding::Tag2Of3 | Encoding::Tag2Of3Uneven => {
                let three = if self == Encoding::Tag2Of3 { even(bytes)? } else { uneven(bytes)? };
                values[..3].copy_from_slice(&three);
                return Some(3);
            }
            Encoding::Tag8Of4 => {
                let tag = bytes.byte()?;
                let mut nibbles = Nibbles { bytes, low: None };
                for (i, value) in values.iter_mut().enumerate().take(4) {
                    *value = nibbles.signed([0, 1, 2, 4][usize::from(tag >> (2 * i) & 3)])?;
                }
                return Some(4);
            }
        }
        Some(1)
    }
}

/// Of a number with higher bits set, which no firmware writes, the same as blackbox_decode makes of it.
fn fourteen_bits(number: u32) -> i64 {
    if number & 0x2000 == 0 { i64::from(number & 0xffff) } else { extend(number, 14) }
}

fn even(bytes: &mut FrameBytes) -> Option<[i64; 3]> {
    let first = u32::from(bytes.byte()?);
    Some(match first >> 6 {
        0 => [extend(first >> 4, 2), extend(first >> 2, 2), extend(first, 2)],
        1 => {
            let second = u32::from(bytes.byte()?);
            [extend(first, 4), extend(second >> 4, 4), extend(second, 4)]
        }
        2 => [extend(first, 6), extend(bytes.byte()?.into(), 6), extend(bytes.byte()?.into(), 6)],
        _ => wide(first, bytes)?,
    })
}

fn uneven(bytes: &mut FrameBytes) -> Option<[i64; 3]> {
    let first = u32::from(bytes.byte()?);
    Some(match first >> 6 {
        0 => [extend(first >> 4, 2), extend(first >> 2, 2), extend(first, 2)],
        1 => {
            let bits = first << 8 | u32::from(bytes.byte()?);
            [extend(bits >> 9, 5), extend(bits >> 4, 5), extend(bits, 4)]
        }
        2 => {
            let bits = first << 16 | u32::from(bytes.byte()?) << 8 | u32::from(bytes.byte()?);
            [extend(bits >> 14, 8), extend(bits >> 7, 7), extend(bits, 7)]
        }
        _ => wide(first, bytes)?,
    })
}

/// Three numbers of whole bytes; two bits of the tag for each.
fn wide(tag: u32, bytes: &mut FrameBytes) -> Option<[i64; 3]> {
    let mut number = |i: u32| bytes.little_endian(1 + (tag >> (2 * i) & 3));
    Some([number(0)?, number(1)?, number(2)?])
}

/// Half bytes, the upper one first.
struct Nibbles<'b, 'a> {
    bytes: &'b mut FrameBytes<'a>,
    low: Option<u8>,
}

impl Nibbles<'_, '_> {
    /// A number of so many half bytes, the highest first.
    fn signed(&mut self, count: u32) -> Option<i64> {
        let mut number = 0;
        for _ in 0..count {
            let nibble = match self.low.take() {
                Some(low) => low,
                None => {
                    let byte = self.bytes.byte()?;
                    self.low = Some(byte & 0xf);
                    byte >> 4
                }
            };
            number = number << 4 | u32::from(nibble);
        }
        Some(if count == 0 { 0 } else { extend(number, 4 * count) })
    }
}
