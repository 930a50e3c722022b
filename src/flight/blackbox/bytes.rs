//! Numbers as blackbox frames pack them, from a place in the file onwards. `None` where the file ends first.

pub struct FrameBytes<'a> {
    bytes: &'a [u8],
    pub at: usize,
}

impl<'a> FrameBytes<'a> {
    pub fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    pub fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    pub fn skip(&mut self, count: usize) -> Option<()> {
        self.at = self.at.checked_add(count).filter(|&at| at <= self.bytes.len())?;
        Some(())
    }

    /// Seven bits a byte, the lowest first; the eighth bit says that another byte follows. More than five bytes are 0,
    /// as blackbox_decode has it.
    pub fn unsigned(&mut self) -> Option<u32> {
        let mut number = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            number |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        Some(0)
    }

    /// As `unsigned`, with the sign in the lowest bit.
    pub fn signed(&mut self) -> Option<i64> {
        let number = self.unsigned()?;
        Some(i64::from((number >> 1).cast_signed() ^ -(number & 1).cast_signed()))
    }

    /// A number of one to four bytes, the lowest first.
    pub fn little_endian(&mut self, count: u32) -> Option<i64> {
        let mut number = 0;
        for i in 0..count {
            number |= u32::from(self.byte()?) << (8 * i);
        }
        Some(extend(number, 8 * count))
    }
}

/// The lowest `bits` of a number, as one with a sign.
pub fn extend(number: u32, bits: u32) -> i64 {
    let unused = 32 - bits;
    i64::from((number << unused).cast_signed() >> unused)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variable_bytes() {
        let mut bytes =
            FrameBytes::new(&[0x7f, 0xff, 0xff, 0xff, 0xff, 0x0f, 3, 0xff, 0xff, 0xff, 0xff, 0xff, 1, 0x80], 0);
        assert_eq!((bytes.unsigned(), bytes.unsigned(), bytes.signed()), (Some(127), Some(u32::MAX), Some(-2)));
        assert_eq!((bytes.unsigned(), bytes.at), (Some(0), 12), "longer than five bytes");
        assert_eq!((bytes.signed(), bytes.unsigned()), (Some(-1), None));
        assert_eq!(FrameBytes::new(&[0, 0, 0x80], 0).little_endian(3), Some(-(1 << 23)));
        assert_eq!((extend(0x3, 2), extend(0x1f, 6), extend(u32::MAX, 32)), (-1, 31, -1));
    }
}
