//! JSON messages.

use super::cdr::LIST;
use super::column::{Columns, seconds};
use serde_json::{Map, Value};
use std::fmt::Write;

/// Adds what `data` holds to the row being read.
pub fn decode(data: &[u8], columns: &mut Columns) -> Result<(), String> {
    let message: Value = serde_json::from_slice(data).map_err(|error| format!("a message is not JSON: {error}"))?;
    if !message.is_object() {
        return Err("a message is not a JSON object".into());
    }
    read(&message, &mut String::new(), columns)
}

fn read(value: &Value, path: &mut String, columns: &mut Columns) -> Result<(), String> {
    let length = path.len();
    let number = match value {
        Value::Bool(flag) => Some(f64::from(*flag)),
        Value::Number(number) => number.as_f64(),
        Value::Object(fields) => time(fields),
        Value::Array(_) | Value::Null | Value::String(_) => None,
    };
    match (number, value) {
        (Some(number), _) => {
            let column = columns.column(path)?;
            columns.set(column, number);
        }
        (None, Value::Object(fields)) => {
            for (name, value) in fields {
                path.push_str(if length == 0 { "" } else { "." });
                path.push_str(name);
                read(value, path, columns)?;
                path.truncate(length);
            }
        }
        (None, Value::Array(items)) if items.len() <= LIST => {
            for (i, value) in items.iter().enumerate() {
                write!(path, "[{i}]").expect("a string grows");
                read(value, path, columns)?;
                path.truncate(length);
            }
        }
        _ => {}
    }
    Ok(())
}

/// Seconds, if these are the two fields of a time.
fn time(fields: &Map<String, Value>) -> Option<f64> {
    let nanoseconds = fields.get("nsec").or_else(|| fields.get("nanosec"))?;
    if fields.len() == 2 { Some(seconds(fields.get("sec")?.as_i64()?, nanoseconds.as_i64()?)) } else { None }
}
