//! Protobuf messages, decoded by the descriptors that the file holds.

use super::cdr::LIST;
use super::column::Columns;
use prost_reflect::{DescriptorPool, DynamicMessage, MessageDescriptor, ReflectMessage, Value};
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The type called `name` in a serialized `FileDescriptorSet`.
pub fn schema(name: &str, descriptors: &[u8]) -> Result<MessageDescriptor, String> {
    let pool = guard(|| DescriptorPool::decode(descriptors).map_err(|error| error.to_string()))
        .map_err(|error| format!("its descriptors are damaged: {error}"))?;
    pool.get_message_by_name(name).ok_or_else(|| format!("its descriptors do not hold {name}"))
}

/// Adds what `data` holds to the row being read. Fields without presence are 0 where the message leaves them out.
pub fn decode(schema: &MessageDescriptor, data: &[u8], columns: &mut Columns) -> Result<(), String> {
    let message = guard(|| DynamicMessage::decode(schema.clone(), data).map_err(|error| error.to_string()))
        .map_err(|error| format!("a message is damaged: {error}"))?;
    fields(&message, &mut String::new(), columns)
}

/// The reflection library panics on some descriptors that no compiler makes, such as maps with keys that are not numbers
/// or strings. It shares nothing with the caller that a panic could leave half done.
fn guard<T>(decode: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(decode)).unwrap_or(Err("its descriptors contradict themselves".into()))
}

fn fields(message: &DynamicMessage, path: &mut String, columns: &mut Columns) -> Result<(), String> {
    let length = path.len();
    for field in message.descriptor().fields() {
        if field.supports_presence() && !message.has_field(&field) {
            continue;
        }
        path.push_str(if length == 0 { "" } else { "." });
        path.push_str(field.name());
        read(&message.get_field(&field), path, columns)?;
        path.truncate(length);
    }
    Ok(())
}

fn read(value: &Value, path: &mut String, columns: &mut Columns) -> Result<(), String> {
    let number = match value {
        Value::Bool(flag) => f64::from(*flag),
        Value::I32(number) | Value::EnumNumber(number) => f64::from(*number),
        Value::I64(number) => *number as f64,
        Value::U32(number) => f64::from(*number),
        Value::U64(number) => *number as f64,
        Value::F32(number) => f64::from(*number),
        Value::F64(number) => *number,
        Value::Message(message) => match time(message) {
            Some(seconds) => seconds,
            None => return fields(message, path, columns),
        },
        Value::List(items) if items.len() <= LIST => {
            let length = path.len();
            for (i, item) in items.iter().enumerate() {
                write!(path, "[{i}]").expect("a string grows");
                read(item, path, columns)?;
                path.truncate(length);
            }
            return Ok(());
        }
        Value::List(_) | Value::Map(_) | Value::String(_) | Value::Bytes(_) => return Ok(()),
    };
    let column = columns.column(path)?;
    columns.set(column, number);
    Ok(())
}

/// Seconds, if this is one of the well-known types for times.
fn time(message: &DynamicMessage) -> Option<f64> {
    let descriptor = message.descriptor();
    if !matches!(descriptor.full_name(), "google.protobuf.Timestamp" | "google.protobuf.Duration") {
        return None;
    }
    let seconds = message.get_field_by_name("seconds")?.as_i64()?;
    Some(seconds as f64 + f64::from(message.get_field_by_name("nanos")?.as_i32()?) / 1e9)
}
