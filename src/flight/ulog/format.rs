//! Message formats of a ULog file, unfolded into numbers at byte offsets.

use crate::flight::number::Number;
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
    number: Number,
    /// From the start of the record.
    offset: usize,
}

/// The number that a type's name stands for.
fn number(name: &str) -> Option<Number> {
    Some(match name {
        "int8_t" => Number::I8,
        "uint8_t" | "bool" | "char" => Number::U8,
        "int16_t" => Number::I16,
        "uint16_t" => Number::U16,
        "int32_t" => Number::I32,
        "uint32_t" => Number::U32,
        "int64_t" => Number::I64,
        "uint64_t" => Number::U64,
        "float" => Number::F32,
        "double" => Number::F64,
        _ => return None,
    })
}

impl Leaf {
    /// Where it ends in a record.
    pub fn end(&self) -> usize {
        self.offset + self.number.size()
    }

    /// NaN where the record is too short.
    pub fn value(&self, record: &[u8]) -> f64 {
        record.get(self.offset..self.end()).and_then(|bytes| self.number.value(bytes)).unwrap_or(f64::NAN)
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
                match number(kind) {
                    Some(number) => {
                        self.leaves.push(Leaf { name: path, number, offset: self.offset });
                        self.offset += number.size();
                    }
                    None => self.format(kind, &format!("{path}."), depth + 1)?,
                }
            }
        }
        Ok(())
    }
}
