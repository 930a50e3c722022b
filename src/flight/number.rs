//! Numbers as binary logs store them.

/// A kind of number. A flag is one as well: 0 or 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    Bool,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Number {
    /// Bytes that it takes.
    pub fn size(self) -> usize {
        match self {
            Self::Bool | Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The value of its bytes, the least first; `None` unless there are as many as it takes.
    pub fn value(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Self::Bool => f64::from(bytes.try_into().ok().map(u8::from_le_bytes)? != 0),
            Self::I8 => i8::from_le_bytes(bytes.try_into().ok()?).into(),
            Self::U8 => u8::from_le_bytes(bytes.try_into().ok()?).into(),
            Self::I16 => i16::from_le_bytes(bytes.try_into().ok()?).into(),
            Self::U16 => u16::from_le_bytes(bytes.try_into().ok()?).into(),
            Self::I32 => i32::from_le_bytes(bytes.try_into().ok()?).into(),
            Self::U32 => u32::from_le_bytes(bytes.try_into().ok()?).into(),
            Self::I64 => i64::from_le_bytes(bytes.try_into().ok()?) as f64,
            Self::U64 => u64::from_le_bytes(bytes.try_into().ok()?) as f64,
            Self::F32 => f32::from_le_bytes(bytes.try_into().ok()?).into(),
            Self::F64 => f64::from_le_bytes(bytes.try_into().ok()?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_their_bytes() {
        let bytes = [0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff];
        let signed = [Number::I8, Number::I16, Number::I32, Number::I64];
        assert_eq!(signed.map(|number| number.value(&bytes[..number.size()])), [Some(-2.0); 4]);
        let unsigned = [Number::U8, Number::U16, Number::U32, Number::U64];
        let largest = [254.0, 65534.0, 4294967294.0, 1.8446744073709552e19];
        assert_eq!(unsigned.map(|number| number.value(&bytes[..number.size()])), largest.map(Some));
        assert_eq!(Number::F32.value(&1.5f32.to_le_bytes()), Some(1.5));
        assert_eq!(Number::F64.value(&(-0.1f64).to_le_bytes()), Some(-0.1));
        assert_eq!((Number::Bool.value(&[2]), Number::Bool.value(&[0])), (Some(1.0), Some(0.0)));
        assert_eq!((Number::I16.value(&[1]), Number::U8.value(&[])), (None, None));
    }
}
