//! CDR messages, decoded by the schema that the file holds.

use super::bytes::Bytes;
use super::column::Columns;
use super::schema::{Fields, Number, Schema, Type};

/// Longer lists are images and point clouds, not measurements of a vehicle.
pub const LIST: usize = 64;

/// Bytes of a field path.
const PATH: usize = 1024;

/// Decodes the messages of one channel.
pub struct Decoder {
    structs: Vec<Fields>,
    root: Type,
    plan: Option<Node>,
}

/// A type with the columns that its numbers go to.
enum Node {
    Number(Number, usize),
    Time(usize),
    Text,
    Struct(Vec<Node>),
    /// `items` grow with the longest list met.
    List {
        of: Type,
        count: Option<usize>,
        path: String,
        items: Vec<Node>,
    },
}

impl Decoder {
    pub fn new(schema: Schema) -> Self {
        Self { structs: schema.structs, root: schema.root, plan: None }
    }

    /// Adds what `data` holds to the row being read.
    pub fn decode(&mut self, data: &[u8], columns: &mut Columns) -> Result<(), String> {
        let mut bytes = Bytes(data);
        let [_, kind, ..] = bytes.array::<4>().ok_or("a message is shorter than its CDR header")?;
        let big = match kind {
            0 => true,
            1 => false,
            _ => return Err(format!("its CDR has representation {kind}; 0 and 1, plain CDR, can be read")),
        };
        let (structs, mut input) = (&self.structs, Input { all: bytes.0.len(), rest: bytes, big });
        let plan = match &mut self.plan {
            Some(plan) => plan,
            none => none.insert(plan(structs, &self.root, String::new(), columns)?),
        };
        read(structs, plan, &mut input, columns)
    }
}

fn plan(structs: &[Fields], of: &Type, path: String, columns: &mut Columns) -> Result<Node, String> {
    if path.len() > PATH {
        return Err(format!("a field's path is longer than {PATH} bytes"));
    }
    columns.spend(128 + path.len())?;
    Ok(match of {
        Type::Number(number) => Node::Number(*number, columns.column(&path)?),
        Type::Time => Node::Time(columns.column(&path)?),
        Type::Text => Node::Text,
        Type::Struct(at) => {
            let fields = structs[*at].iter().map(|(name, of)| {
                let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                plan(structs, of, path, columns)
            });
            Node::Struct(fields.collect::<Result<_, _>>()?)
        }
        Type::List { of, count } => Node::List { of: (**of).clone(), count: *count, path, items: Vec::new() },
        Type::Named(name) => unreachable!("{name} was linked"),
    })
}

fn read(structs: &[Fields], node: &mut Node, input: &mut Input, columns: &mut Columns) -> Result<(), String> {
    match node {
        Node::Number(number, column) => columns.set(*column, input.number(*number).ok_or(SHORT)?),
        Node::Time(column) => columns.set(*column, input.time().ok_or(SHORT)?),
        Node::Text => input.text().ok_or(SHORT)?,
        Node::Struct(fields) => {
            for field in fields {
                read(structs, field, input, columns)?;
            }
        }
        Node::List { of, count, path, items } => {
            let n = count.or_else(|| input.length()).ok_or(SHORT)?;
            if n > LIST {
                return skip_list(structs, of, n, input).ok_or(SHORT.into());
            }
            while items.len() < n {
                items.push(plan(structs, of, format!("{path}[{}]", items.len()), columns)?);
            }
            for item in &mut items[..n] {
                read(structs, item, input, columns)?;
            }
        }
    }
    Ok(())
}

const SHORT: &str = "a message is shorter than its schema says";

/// Every type takes at least a byte, so that this ends with the message at the latest.
fn skip(structs: &[Fields], of: &Type, input: &mut Input) -> Option<()> {
    match of {
        Type::Number(number) => input.number(*number).map(|_| ()),
        Type::Time => input.time().map(|_| ()),
        Type::Text => input.text(),
        Type::Struct(at) => structs[*at].iter().try_for_each(|(_, of)| skip(structs, of, input)),
        Type::List { of, count } => {
            let n = count.or_else(|| input.length())?;
            skip_list(structs, of, n, input)
        }
        Type::Named(name) => unreachable!("{name} was linked"),
    }
}

fn skip_list(structs: &[Fields], of: &Type, n: usize, input: &mut Input) -> Option<()> {
    if let Type::Number(number) = of
        && n > 0
    {
        input.align(number.size())?;
        return input.rest.take(n.checked_mul(number.size())?).map(|_| ());
    }
    (0..n).try_for_each(|_| skip(structs, of, input))
}

/// What follows the CDR header, which alignment counts from.
struct Input<'a> {
    all: usize,
    rest: Bytes<'a>,
    big: bool,
}

impl Input<'_> {
    fn align(&mut self, size: usize) -> Option<()> {
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

    fn number(&mut self, number: Number) -> Option<f64> {
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

    fn time(&mut self) -> Option<f64> {
        Some(self.number(Number::I32)? + self.number(Number::U32)? / 1e9)
    }

    fn length(&mut self) -> Option<usize> {
        self.array().map(|length| u32::from_le_bytes(length) as usize)
    }

    fn text(&mut self) -> Option<()> {
        let length = self.length()?;
        self.rest.take(length).map(|_| ())
    }
}
