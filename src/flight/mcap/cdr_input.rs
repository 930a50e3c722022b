//! Numbers and strings as CDR stores them.

use crate::flight::mcap::bytes::Bytes;
use crate::flight::mcap::column::seconds;
use crate::flight::number::Number;

/// What follows the CDR header, which alignment counts from.
pub struct Input<'a> {
    pub all: usize,
    pub rest: Bytes<'a>,
    pub big: bool,
}

impl<'a> Input<'a> {
    pub fn new(bytes: &'a [u8], big: bool) -> Self {
        Self { all: bytes.len(), rest: Bytes(bytes), big }
    }

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

    /// A number, aligned to its size.
    pub fn number(&mut self, number: Number) -> Option<f64> {
        self.align(number.size())?;
        let bytes = self.rest.take(number.size())?;
        if !self.big {
            return number.value(bytes);
        }
        let mut turned = [0; 8];
        turned[..bytes.len()].copy_from_slice(bytes);
        turned[..bytes.len()].reverse();
        number.value(&turned[..bytes.len()])
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
