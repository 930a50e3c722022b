//! Protobuf messages, decoded by the descriptors that the file holds.
//!
//! Own code, because the reflection library panics on descriptors that contradict themselves, and takes many times the
//! bytes of a message.

mod descriptor;
mod wire;

use super::cdr::LIST;
use super::column::{Columns, seconds};
pub use descriptor::Descriptors;
use descriptor::{Field, FieldKind};
use std::fmt::Write;
use wire::{Wire, values};

/// Messages within messages that are followed.
const DEPTH: usize = 32;

/// Adds what `data` holds to the row being read. Fields without presence are 0 where the message leaves them out.
pub fn decode(schema: &Descriptors, data: &[u8], columns: &mut Columns) -> Result<(), String> {
    MessageReader { schema, columns, path: String::new(), depth: 0 }.message(schema.root, data)
}

struct MessageReader<'a> {
    schema: &'a Descriptors,
    columns: &'a mut Columns,
    path: String,
    depth: usize,
}

impl MessageReader<'_> {
    fn message(&mut self, of: usize, data: &[u8]) -> Result<(), String> {
        let of = &self.schema.messages[of];
        let values = values(data).ok_or("a message is damaged")?;
        if of.time {
            let part = |number| values.get(&number).and_then(|values| values.last()).map_or(0, Wire::bits) as i64;
            return self.set(seconds(part(1), part(2)));
        }
        if self.depth == DEPTH {
            return Err(format!("a message nests more than {DEPTH} deep"));
        }
        self.depth += 1;
        let length = self.path.len();
        for (number, field) in &of.fields {
            let values = values.get(number).map_or(&[][..], Vec::as_slice);
            self.path.push_str(if length == 0 { "" } else { "." });
            self.path.push_str(&field.name);
            if field.repeated {
                self.list(field, values)?;
            } else if let Some(&last) = values.last() {
                self.single(field, last)?;
            } else if !field.presence {
                self.single(field, Wire::Number(0))?;
            }
            self.path.truncate(length);
        }
        self.depth -= 1;
        Ok(())
    }

    fn list(&mut self, field: &Field, values: &[Wire]) -> Result<(), String> {
        let mut items = Vec::new();
        for &value in values {
            match (value, field.kind) {
                (Wire::Bytes(packed), FieldKind::Number(number)) => {
                    items.extend(number.unpack(packed).ok_or("a message is damaged")?);
                }
                _ => items.push(value),
            }
        }
        if items.len() > LIST {
            return Ok(());
        }
        let length = self.path.len();
        for (i, &item) in items.iter().enumerate() {
            write!(self.path, "[{i}]").expect("a string grows");
            self.single(field, item)?;
            self.path.truncate(length);
        }
        Ok(())
    }

    fn single(&mut self, field: &Field, value: Wire) -> Result<(), String> {
        match (field.kind, value) {
            (FieldKind::Number(number), Wire::Number(bits)) => self.set(number.value(bits)),
            (FieldKind::Message(of), Wire::Bytes(data)) => self.message(of, data),
            (FieldKind::Other, _) => Ok(()),
            (FieldKind::Number(_) | FieldKind::Message(_), _) => {
                Err(format!("{} is not what its descriptors say", self.path))
            }
        }
    }

    fn set(&mut self, number: f64) -> Result<(), String> {
        let column = self.columns.column(&self.path)?;
        self.columns.set(column, number);
        Ok(())
    }
}
