//! What happened beside the measured rows.

use super::bytes::FrameBytes;

/// An event, and up to two numbers that say more; NaN where it has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    pub kind: u8,
    pub first: f64,
    pub second: f64,
}

pub const LOGGING_RESUME: u8 = 14;
pub const DISARM: u8 = 15;
pub const LOG_END: u8 = 255;
const LAST_WORDS: &[u8; 11] = b"End of log\0";

impl Event {
    /// Reads what follows an `E`. Of a kind that nobody declared only the kind is read, and `known` is false.
    pub fn read(bytes: &mut FrameBytes, inav: bool) -> Option<(Self, bool)> {
        let kind = bytes.byte()?;
        let (mut first, mut second, mut known) = (f64::NAN, f64::NAN, true);
        match kind {
            // The moment of a beep; of Rotorflight the states of governor, rescue and flight; why it was disarmed.
            0 | DISARM | 50..=52 => first = bytes.unsigned()?.into(),
            // An error of INAV's attitude; others try motors with it.
            40 if inav => first = bytes.unsigned()?.into(),
            40 => bytes.skip(5)?,
            // Steps of tuning in the air that old firmware had.
            10 => bytes.skip(5)?,
            11 => bytes.skip(4)?,
            12 => bytes.skip(8)?,
            20 => {
                bytes.skip(1)?;
                bytes.signed()?;
                bytes.skip(2)?;
            }
            // A setting changed in flight: which, and to what.
            13 => {
                let setting = bytes.byte()?;
                first = f64::from(setting & 0x7f);
                second = if setting > 0x7f {
                    f32::from_bits(bytes.little_endian(4)? as u32).into()
                } else {
                    bytes.signed()? as f64
                };
            }
            // Logging goes on: iteration and time. Flight modes: new and old.
            LOGGING_RESUME | 30 => {
                first = bytes.unsigned()?.into();
                second = bytes.unsigned()?.into();
            }
            // Rotorflight's own data and text.
            100 | 101 => {
                let length = bytes.byte()?;
                bytes.skip(length.into())?;
            }
            LOG_END => {
                for word in LAST_WORDS {
                    known &= bytes.byte()? == *word;
                }
            }
            _ => known = false,
        }
        Some((Self { kind, first, second }, known))
    }
}
