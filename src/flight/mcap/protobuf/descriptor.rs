//! Message types from a serialized `FileDescriptorSet`.

use super::wire::WireNumber;
use prost::Message as _;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorSet};
use std::collections::{BTreeMap, HashMap};

#[derive(Debug)]
pub struct Descriptors {
    pub messages: Vec<Message>,
    /// Position of the type that the file's messages have.
    pub root: usize,
}

#[derive(Debug)]
pub struct Message {
    pub fields: BTreeMap<u32, Field>,
    /// Seconds and nanoseconds, in fields 1 and 2.
    pub time: bool,
}

#[derive(Debug)]
pub struct Field {
    pub name: String,
    pub repeated: bool,
    /// Whether a field that is not transmitted is missing, and not zero.
    pub presence: bool,
    pub kind: FieldKind,
}

#[derive(Clone, Copy, Debug)]
pub enum FieldKind {
    Number(WireNumber),
    /// Position of its type.
    Message(usize),
    /// Text and the like.
    Other,
}

impl Descriptors {
    /// The type called `name`.
    pub fn new(name: &str, descriptors: &[u8]) -> Result<Self, String> {
        let set =
            FileDescriptorSet::decode(descriptors).map_err(|error| format!("its descriptors are damaged: {error}"))?;
        let mut found = Vec::new();
        for file in &set.file {
            let implicit = file.syntax() == "proto3";
            for message in &file.message_type {
                collect(file.package(), message, implicit, &mut found);
            }
        }
        let by_name: HashMap<_, _> = found.iter().enumerate().map(|(i, (name, ..))| (name.as_str(), i)).collect();
        let root = *by_name.get(name).ok_or_else(|| format!("its descriptors do not hold {name}"))?;
        let message = |(name, message, implicit): &(String, &DescriptorProto, bool)| {
            let fields = message
                .field
                .iter()
                .map(|of| Ok((u32::try_from(of.number()).ok(), field(of, *implicit, &found, &by_name)?)));
            let fields = fields.collect::<Result<Vec<_>, String>>()?;
            let fields = fields.into_iter().filter_map(|(number, field)| Some((number?, field))).collect();
            let time = matches!(name.as_str(), "google.protobuf.Timestamp" | "google.protobuf.Duration");
            Ok(Message { fields, time })
        };
        Ok(Self { messages: found.iter().map(message).collect::<Result<_, String>>()?, root })
    }
}

/// The type and those within it, by their full names, and whether their fields lack presence.
fn collect<'d>(
    scope: &str,
    message: &'d DescriptorProto,
    implicit: bool,
    found: &mut Vec<(String, &'d DescriptorProto, bool)>,
) {
    let name = if scope.is_empty() { message.name().to_string() } else { format!("{scope}.{}", message.name()) };
    for nested in &message.nested_type {
        collect(&name, nested, implicit, found);
    }
    found.push((name, message, implicit));
}

fn field(
    of: &FieldDescriptorProto,
    implicit: bool,
    found: &[(String, &DescriptorProto, bool)],
    by_name: &HashMap<&str, usize>,
) -> Result<Field, String> {
    let kind = FieldKind::Number(match of.r#type() {
        Type::Bool => WireNumber::Bool,
        Type::Int32 | Type::Int64 | Type::Enum => WireNumber::Signed,
        Type::Uint32 | Type::Uint64 => WireNumber::Unsigned,
        Type::Sint32 | Type::Sint64 => WireNumber::Zigzag,
        Type::Fixed32 => WireNumber::Fixed32,
        Type::Fixed64 => WireNumber::Fixed64,
        Type::Sfixed32 => WireNumber::Sfixed32,
        Type::Sfixed64 => WireNumber::Sfixed64,
        Type::Float => WireNumber::Float,
        Type::Double => WireNumber::Double,
        Type::Message => return message_field(of, found, by_name),
        Type::String | Type::Bytes | Type::Group => return Ok(new(of, true, FieldKind::Other)),
    });
    Ok(new(of, !implicit || of.proto3_optional() || of.oneof_index.is_some(), kind))
}

/// Maps have no path for what they hold.
fn message_field(
    of: &FieldDescriptorProto,
    found: &[(String, &DescriptorProto, bool)],
    by_name: &HashMap<&str, usize>,
) -> Result<Field, String> {
    let name = of.type_name().trim_start_matches('.');
    let at = *by_name.get(name).ok_or_else(|| format!("its descriptors do not hold {name}"))?;
    let map = found[at].1.options.as_ref().is_some_and(|options| options.map_entry());
    Ok(new(of, true, if map { FieldKind::Other } else { FieldKind::Message(at) }))
}

fn new(of: &FieldDescriptorProto, presence: bool, kind: FieldKind) -> Field {
    Field { name: of.name().into(), repeated: of.label() == Label::Repeated, presence, kind }
}
