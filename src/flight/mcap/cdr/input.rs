//! Numbers and strings as CDR stores them.

use crate::flight::mcap::bytes::Bytes;
use crate::flight::mcap::column::seconds;
use crate::flight::mcap::schema::Number;

/// What follows the CDR header, which alignment counts from.
pub struct Input<'a> {
    pub all: usize,
    pub rest: Bytes<'a>,
    pub big: bool,
}

impl Input<'_> {
    pub fn align(&mut self, size: usize) -> Option<()> {
        let at = self.all - self.rest.0.len();
        self.rest.take(at.next_multiple_of(size) - at).map(|_| ())
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.align(N)?;
        let mut array = self.rest.array()?;
        if self.big {
            array.reverse();
        }
        Some(array)
    }

    pub fn number(&mut self, number: Number) -> Option<f64> {
        Some(match number {
            Number::Bool => f64::from(self.array::<1>()? != [0]),
            Number::I8 => i8::from_le_bytes(self.array()?).into(),
            Number::U8 => u8::from_le_bytes(self.array()?).into(),
            Number::I16 => i16::from_le_bytes(self.array()?).into(),
            Number::U16 => u16::from_le_bytes(self.array()?).into(),
            Number::I32 => i32::from_le_bytes(self.array()?).into(),
            Number::U32 => u32::from_le_bytes(self.array()?).into(),
            Number::I64 => i64::from_le_bytes(self.array()?) as f64,
            Number::U64 => u64::from_le_bytes(self.array()?) as f64,
            Number::F32 => f32::from_le_bytes(self.array()?).into(),
            Number::F64 => f64::from_le_bytes(self.array()?),
        })
    }

    pub fn time(&mut self) -> Option<f64> {
        let whole = i32::from_le_bytes(self.array()?);
        Some(seconds(whole.into(), u32::from_le_bytes(self.array()?).into()))
    }

    pub fn length(&mut self) -> Option<usize> {
        self.array().map(|length| u32::from_le_bytes(length) as usize)
    }

    pub fn text(&mut self) -> Option<()> {
        let length = self.length()?;
        self.rest.take(length).map(|_| ())
    }
}
