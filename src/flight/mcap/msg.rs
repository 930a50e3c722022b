//! `ros2msg` schemas: the `.msg` files of a message and of the types it uses, one after the other.
//!
//! Own code, because the crate that reads them panics on some defaults and refuses messages for constants it cannot
//! read, which a decoder does not need.

use super::schema::{CdrSchema, Definition, Fields, Type};
use crate::flight::number::Number;
use std::collections::HashMap;

/// The layout of the message called `name`, such as `sensor_msgs/msg/Imu`.
pub fn schema(name: &str, text: &str) -> Result<CdrSchema, String> {
    let root = scoped(name);
    let mut definitions = HashMap::new();
    let mut current = (root.clone(), Fields::new());
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if let Some(name) = line.strip_prefix("MSG:") {
            let (done, fields) = std::mem::replace(&mut current, (scoped(name.trim()), Fields::new()));
            definitions.insert(done, Definition::Struct(fields));
        } else if !line.is_empty() && !line.starts_with("===") {
            current.1.extend(field(line)?);
        }
    }
    definitions.insert(current.0, Definition::Struct(current.1));
    CdrSchema::link(definitions, &root)
}

/// `pkg/msg/Type` and `pkg/Type` are the same type.
fn scoped(name: &str) -> String {
    let parts: Vec<_> = name.split('/').collect();
    match parts.as_slice() {
        [package, "msg", name] => format!("{package}::{name}"),
        parts => parts.join("::"),
    }
}

/// Name and type, none for a constant. Defaults are of no interest here.
fn field(line: &str) -> Result<Option<(String, Type)>, String> {
    let (of, rest) = line.split_once(char::is_whitespace).ok_or_else(|| format!("its schema has the line {line:?}"))?;
    let rest = rest.trim_start();
    let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
    let (name, value) = rest.split_at(end);
    Ok(if value.trim_start().starts_with('=') { None } else { Some((name.into(), list(of)?)) })
}

fn list(of: &str) -> Result<Type, String> {
    let Some((of, size)) = of.strip_suffix(']').and_then(|of| of.split_once('[')) else {
        return Ok(single(of));
    };
    let count = match size {
        size if size.is_empty() || size.starts_with("<=") => None,
        size => Some(size.parse().map_err(|_| format!("its schema has an array of size {size:?}"))?),
    };
    Ok(Type::List { of: Box::new(single(of)), count })
}

fn single(of: &str) -> Type {
    Type::Number(match of.split("<=").next().unwrap_or_default() {
        "bool" => Number::Bool,
        "int8" => Number::I8,
        "uint8" | "byte" | "char" => Number::U8,
        "int16" => Number::I16,
        "uint16" => Number::U16,
        "int32" => Number::I32,
        "uint32" => Number::U32,
        "int64" => Number::I64,
        "uint64" => Number::U64,
        "float32" => Number::F32,
        "float64" => Number::F64,
        "string" => return Type::Text,
        name => return Type::Named(scoped(name)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_constants_and_defaults() {
        let text = "uint8 FOO=0x10 # hex\nbool enabled true\nstring<=4 s \"\nPart[<=2] parts\n\
                    float32[3] xyz [0, 0, 1]\nbuiltin_interfaces/Time stamp\n===\nMSG: p/Part\nint8 a\n\
                    ================\nMSG: p/msg/Unused\nwstring w";
        let schema = schema("p/msg/Root", text).unwrap();
        let Type::Struct(root) = schema.root else { panic!("{schema:?}") };
        let names: Vec<_> = schema.structs[root].iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["enabled", "s", "parts", "xyz", "stamp"]);
        assert_eq!(schema.structs[root][4].1, Type::Time);
        assert_eq!(schema.structs.len(), 2);
    }

    #[test]
    fn what_cannot_be_laid_out_is_an_error() {
        for text in ["float32", "float32[x] a", "Missing m", "wstring w", "Root r", "int32[3][4] a", "int32[0] a"] {
            assert!(schema("p/msg/Root", text).is_err(), "{text}");
        }
    }
}
