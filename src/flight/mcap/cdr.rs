//! CDR messages, decoded by the schema that the file holds.

use super::bytes::Bytes;
use super::cdr_input::Input;
use super::column::Columns;
use super::schema::{CdrSchema, Fields, Type};
use crate::flight::number::Number;

/// Longer lists are images and point clouds, not measurements of a vehicle.
pub const LIST: usize = 64;

/// Bytes of a field path.
const PATH: usize = 1024;

/// Nodes of a plan.
const NODES: usize = 1 << 16;

/// Decodes the messages of one channel.
pub struct CdrDecoder {
    structs: Vec<Fields>,
    root: Type,
    plan: Option<CdrNode>,
    nodes: usize,
}

/// A type with the columns that its numbers go to.
enum CdrNode {
    Number(Number, usize),
    Time(usize),
    Text,
    Struct(Vec<CdrNode>),
    /// `items` grow with the longest list met.
    List {
        of: Type,
        count: Option<usize>,
        path: String,
        items: Vec<CdrNode>,
    },
}

impl CdrDecoder {
    pub fn new(schema: CdrSchema) -> Self {
        Self { structs: schema.structs, root: schema.root, plan: None, nodes: 0 }
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
        let mut input = Input::new(bytes.0, big);
        let mut planner = Planner { structs: &self.structs, nodes: &mut self.nodes, columns };
        let plan = match &mut self.plan {
            Some(plan) => plan,
            none => none.insert(planner.plan(&self.root, String::new())?),
        };
        planner.read(plan, &mut input)
    }
}

struct Planner<'a> {
    structs: &'a [Fields],
    nodes: &'a mut usize,
    columns: &'a mut Columns,
}

impl Planner<'_> {
    fn plan(&mut self, of: &Type, path: String) -> Result<CdrNode, String> {
        if path.len() > PATH {
            return Err(format!("a field's path is longer than {PATH} bytes"));
        }
        *self.nodes += 1;
        if *self.nodes > NODES {
            return Err(format!("its messages have more than {NODES} fields"));
        }
        self.columns.spend(128 + path.len())?;
        Ok(match of {
            Type::Number(number) => CdrNode::Number(*number, self.columns.column(&path)?),
            Type::Time => CdrNode::Time(self.columns.column(&path)?),
            Type::Text => CdrNode::Text,
            Type::Struct(at) => {
                let fields = self.structs[*at].iter().map(|(name, of)| {
                    let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                    self.plan(of, path)
                });
                CdrNode::Struct(fields.collect::<Result<_, _>>()?)
            }
            Type::List { of, count } => CdrNode::List { of: (**of).clone(), count: *count, path, items: Vec::new() },
            Type::Named(name) => unreachable!("{name} was linked"),
        })
    }

    fn read(&mut self, node: &mut CdrNode, input: &mut Input) -> Result<(), String> {
        match node {
            CdrNode::Number(number, column) => self.columns.set(*column, input.number(*number).ok_or(SHORT)?),
            CdrNode::Time(column) => self.columns.set(*column, input.time().ok_or(SHORT)?),
            CdrNode::Text => input.text().ok_or(SHORT)?,
            CdrNode::Struct(fields) => {
                for field in fields {
                    self.read(field, input)?;
                }
            }
            CdrNode::List { of, count, path, items } => {
                let n = count.or_else(|| input.length()).ok_or(SHORT)?;
                if n > LIST {
                    return skip_list(self.structs, of, n, input).ok_or(SHORT.into());
                }
                while items.len() < n {
                    items.push(self.plan(of, format!("{path}[{}]", items.len()))?);
                }
                for item in &mut items[..n] {
                    self.read(item, input)?;
                }
            }
        }
        Ok(())
    }
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
