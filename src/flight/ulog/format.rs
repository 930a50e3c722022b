//! Message formats of a ULog file, unfolded into numbers at byte offsets.

use std::collections::HashMap;

/// Nothing that PX4 logs comes near these.
const MOST_LEAVES: usize = 8192;
const MOST_DEPTH: usize = 8;
const MOST_NAME_BYTES: usize = 256;

/// Type and name of each field, by format.
#[derive(Default)]
pub struct Formats<'a> {
    fields: HashMap<&'a str, Vec<(&'a str, &'a str)>>,
}

/// A number in a record.
pub struct Leaf {
    /// Such as `q[2]` or `esc[1].voltage`.
    pub name: String,
    kind: Kind,
    /// From the start of the record.
    offset: usize,
}

#[derive(Clone, Copy)]
enum Kind {
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

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "int8_t" => Kind::I8,
            "uint8_t" | "bool" | "char" => Kind::U8,
            "int16_t" => Kind::I16,
            "uint16_t" => Kind::U16,
            "int32_t" => Kind::I32,
            "uint32_t" => Kind::U32,
            "int64_t" => Kind::I64,
            "uint64_t" => Kind::U64,
            "float" => Kind::F32,
            "double" => Kind::F64,
            _ => return None,
        })
    }

    fn bytes(self) -> usize {
        match self {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::I64 | Kind::U64 | Kind::F64 => 8,
        }
    }
}

impl Leaf {
    /// Where it ends in a record.
    pub fn end(&self) -> usize {
        self.offset + self.kind.bytes()
    }

    /// NaN where the record is too short.
    pub fn value(&self, record: &[u8]) -> f64 {
        let Some(bytes) = record.get(self.offset..self.end()) else { return f64::NAN };
        fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
            std::array::from_fn(|i| bytes[i])
        }
        match self.kind {
            Kind::I8 => i8::from_le_bytes(array(bytes)).into(),
            Kind::U8 => bytes[0].into(),
            Kind::I16 => i16::from_le_bytes(array(bytes)).into(),
            Kind::U16 => u16::from_le_bytes(array(bytes)).into(),
            Kind::I32 => i32::from_le_bytes(array(bytes)).into(),
            Kind::U32 => u32::from_le_bytes(array(bytes)).into(),
            Kind::I64 => i64::from_le_bytes(array(bytes)) as f64,
            Kind::U64 => u64::from_le_bytes(array(bytes)) as f64,
            Kind::F32 => f32::from_le_bytes(array(bytes)).into(),
            Kind::F64 => f64::from_le_bytes(array(bytes)),
        }
    }
}

impl<'a> Formats<'a> {
    /// Takes in `name:type field;type field;`.
    pub fn add(&mut self, payload: &'a [u8]) -> Result<(), String> {
        let text = std::str::from_utf8(payload).map_err(|_| "a format that is no text".to_string())?;
        let (name, fields) = text.split_once(':').ok_or("a format without a name")?;
        let fields = fields.split(';').filter(|field| !field.is_empty());
        let fields: Option<Vec<_>> = fields.map(|field| field.split_once(' ')).collect();
        self.fields.insert(name, fields.ok_or_else(|| format!("a field without a name in the format `{name}`"))?);
        Ok(())
    }

    /// All numbers of a format, in order. Fails on formats that are missing, endless, or much larger than any of PX4.
    pub fn leaves(&self, name: &str) -> Result<Vec<Leaf>, String> {
        let mut unfolding = Unfolding { formats: self, leaves: Vec::new(), offset: 0, steps: 0 };
        unfolding.format(name, "", 0)?;
        let mut leaves = unfolding.leaves;
        leaves.retain(|leaf| !leaf.name.rsplit('.').next().is_some_and(|last| last.starts_with("_padding")));
        Ok(leaves)
    }
}

struct Unfolding<'f, 'a> {
    formats: &'f Formats<'a>,
    leaves: Vec<Leaf>,
    offset: usize,
    /// Fields visited, also those without size.
    steps: usize,
}

impl Unfolding<'_, '_> {
    fn format(&mut self, name: &str, prefix: &str, depth: usize) -> Result<(), String> {
        let fields = self.formats.fields.get(name).ok_or_else(|| format!("no format `{name}`"))?;
        for (kind, field) in fields {
            let (kind, count) = match kind.split_once('[') {
                None => (*kind, None),
                Some((kind, count)) => {
                    let count = count.strip_suffix(']').and_then(|count| count.parse::<u16>().ok());
                    (kind, Some(count.ok_or_else(|| format!("the length of `{field}` in the format `{name}`"))?))
                }
            };
            for i in 0..count.unwrap_or(1) {
                let path = match count {
                    Some(_) => format!("{prefix}{field}[{i}]"),
                    None => format!("{prefix}{field}"),
                };
                self.steps += 1;
                if self.steps > MOST_LEAVES || depth > MOST_DEPTH || path.len() > MOST_NAME_BYTES {
                    return Err(format!("the format `{name}` is too large"));
                }
                match Kind::of(kind) {
                    Some(kind) => {
                        self.leaves.push(Leaf { name: path, kind, offset: self.offset });
                        self.offset += kind.bytes();
                    }
                    None => self.format(kind, &format!("{path}."), depth + 1)?,
                }
            }
        }
        Ok(())
    }
}
