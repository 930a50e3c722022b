//! Files of other recorders.

use mcap::WriteOptions;
use mcap::records::{MessageHeader, Metadata};
use prost_reflect::prost::Message;
use prost_reflect::prost_types::field_descriptor_proto::{Label, Type};
use prost_reflect::prost_types::{
    DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto, FileDescriptorProto,
    FileDescriptorSet,
};
use prost_reflect::{DescriptorPool, DynamicMessage, Value};
use racer::flight::mcap::tables;
use racer::flight::table::{LOG_TIME, Table};
use std::collections::BTreeMap;
use std::io::Cursor;

/// A topic `/t` with messages at 1 s, 2 s, ...; without chunks, so that each byte can be reached.
pub fn file(encoding: &str, schema: Option<(&str, &str, &[u8])>, messages: &[Vec<u8>]) -> Vec<u8> {
    let options = WriteOptions::new().use_chunks(false).calculate_data_section_crc(false);
    let mut file = options.create(Cursor::new(Vec::new())).unwrap();
    let schema = schema.map_or(0, |(name, language, data)| file.add_schema(name, language, data).unwrap());
    let channel_id = file.add_channel(schema, "/t", encoding, &BTreeMap::new()).unwrap();
    for (i, data) in messages.iter().enumerate() {
        let time = (i as u64 + 1) * 1_000_000_000;
        let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
        file.write_to_known_channel(&header, data).unwrap();
    }
    file.finish().unwrap();
    file.into_inner().into_inner()
}

fn table(file: &[u8]) -> Table {
    tables(file, &|_| true).unwrap().tables.remove("/t").unwrap()
}

pub fn json() -> Vec<u8> {
    let messages = [
        br#"{"stamp":{"sec":3,"nsec":500000000},"rate":{"x":1.5,"y":[1,2,{"z":true}]},"name":"a","none":null}"#
            .to_vec(),
        format!(r#"{{"extra":-1e3,"rate":{{"x":2}},"long":[{}0]}}"#, "0,".repeat(64)).into_bytes(),
    ];
    file("json", Some(("any", "jsonschema", b"{}")), &messages)
}

#[test]
fn json_leaves_are_columns() {
    let table = table(&json());
    assert_eq!(table.columns[LOG_TIME], [1.0, 2.0]);
    assert_eq!(table.columns["rate.x"], [1.5, 2.0]);
    for (path, first) in [("stamp", 3.5), ("rate.y[0]", 1.0), ("rate.y[2].z", 1.0)] {
        assert_eq!(table.columns[path][0], first, "{path}");
        assert!(table.columns[path][1].is_nan(), "{path}");
    }
    assert_eq!(table.columns["extra"][1], -1e3);
    assert_eq!(table.columns.len(), 7);
}

const IDL: &str = r#"================================================================================
IDL: drone_msgs/msg/State
// generated from rosidl_adapter/resource/msg.idl.em
#include "std_msgs/msg/Header.idl"

module drone_msgs {
  module msg {
    module State_Constants {
      @verbatim (language="comment", text="a \"quoted\" ) word")
      const uint8 ARMED = 1;
    };
    typedef double double__3[3];
    typedef drone_msgs::msg::Rotor Rotor__2[2];
    struct State {
      std_msgs::msg::Header header;
      @unit (value="rad/s")
      double__3 rates;
      boolean armed; /* a
      comment */
      unsigned long long count;
      string<8> label;
      sequence<float> small;
      sequence<double, 100> large;
      Rotor__2 rotors;
      long a, b[2];
    };
  };
};
================================================================================
IDL: drone_msgs/msg/Rotor
module drone_msgs { module msg {
  enum Kind { LEFT, RIGHT };
  @final struct Rotor { Kind kind; octet id; sequence<string> names; short speed; };
}; };
================================================================================
IDL: std_msgs/msg/Header
module std_msgs { module msg { struct Header { builtin_interfaces::msg::Time stamp; string frame_id; }; }; };
================================================================================
IDL: builtin_interfaces/msg/Time
module builtin_interfaces { module msg { struct Time { int32 sec; uint32 nanosec; }; }; };
"#;

/// A message of the type above, laid out by hand, in either byte order.
fn state(big: bool) -> Vec<u8> {
    let mut bytes = vec![0, u8::from(!big), 0, 0];
    let mut put = |number: &[u8]| {
        bytes.resize(4 + (bytes.len() - 4).next_multiple_of(number.len()), 0);
        if big { bytes.extend(number.iter().rev()) } else { bytes.extend(number) }
    };
    let text = |put: &mut dyn FnMut(&[u8]), text: &str| {
        put(&(text.len() as u32 + 1).to_le_bytes());
        text.bytes().chain([0]).for_each(|byte| put(&[byte]));
    };
    put(&7_i32.to_le_bytes());
    put(&250_000_000_u32.to_le_bytes());
    text(&mut put, "map");
    for rate in [1.0_f64, -2.0, 3.5] {
        put(&rate.to_le_bytes());
    }
    put(&[1]);
    put(&(1_u64 << 40).to_le_bytes());
    text(&mut put, "x");
    put(&2_u32.to_le_bytes());
    for small in [0.5_f32, 0.25] {
        put(&small.to_le_bytes());
    }
    put(&65_u32.to_le_bytes());
    for large in 0..65 {
        put(&f64::from(large).to_le_bytes());
    }
    for rotor in 0..2_u8 {
        put(&u32::from(rotor).to_le_bytes());
        put(&[9 + rotor]);
        put(&1_u32.to_le_bytes());
        text(&mut put, "odd");
        put(&(-300_i16).to_le_bytes());
    }
    for number in [-1_i32, -2, -3] {
        put(&number.to_le_bytes());
    }
    bytes
}

pub fn idl() -> Vec<u8> {
    file("cdr", Some(("drone_msgs/msg/State", "ros2idl", IDL.as_bytes())), &[state(false), state(true)])
}

#[test]
fn cdr_is_read_by_idl_in_both_byte_orders() {
    let table = table(&idl());
    let expected = [
        (LOG_TIME, None),
        ("header.stamp", Some(7.25)),
        ("rates[0]", Some(1.0)),
        ("rates[1]", Some(-2.0)),
        ("rates[2]", Some(3.5)),
        ("armed", Some(1.0)),
        ("count", Some((1_u64 << 40) as f64)),
        ("small[0]", Some(0.5)),
        ("small[1]", Some(0.25)),
        ("rotors[0].kind", Some(0.0)),
        ("rotors[0].id", Some(9.0)),
        ("rotors[0].speed", Some(-300.0)),
        ("rotors[1].kind", Some(1.0)),
        ("rotors[1].id", Some(10.0)),
        ("rotors[1].speed", Some(-300.0)),
        ("a", Some(-1.0)),
        ("b[0]", Some(-2.0)),
        ("b[1]", Some(-3.0)),
    ];
    for (path, value) in expected {
        let column = table.columns.get(path).unwrap_or_else(|| panic!("{path} is missing"));
        assert!(value.is_none_or(|value| *column == [value; 2]), "{path}: {column:?}");
    }
    assert_eq!(table.columns.len(), expected.len());
}

fn field(number: i32, name: &str, of: Type, name_of: &str) -> FieldDescriptorProto {
    FieldDescriptorProto {
        name: Some(name.into()),
        number: Some(number),
        label: Some(if name.ends_with('s') { Label::Repeated } else { Label::Optional } as i32),
        r#type: Some(of as i32),
        type_name: (!name_of.is_empty()).then(|| name_of.into()),
        ..Default::default()
    }
}

fn descriptors() -> FileDescriptorSet {
    let message = |name: &str, field| DescriptorProto { name: Some(name.into()), field, ..Default::default() };
    let file = |package: &str, dependency: &[&str], message_type| FileDescriptorProto {
        name: Some(format!("{package}.proto")),
        package: Some(package.into()),
        dependency: dependency.iter().map(|&dependency| dependency.into()).collect(),
        message_type,
        syntax: Some("proto3".into()),
        ..Default::default()
    };
    let timestamp =
        message("Timestamp", vec![field(1, "seconds", Type::Int64, ""), field(2, "nanos", Type::Int32, "")]);
    let mut timestamp = file("google.protobuf", &[], vec![timestamp]);
    for field in &mut timestamp.message_type[0].field {
        field.label = Some(Label::Optional as i32);
    }
    let vector = message("Vector", vec![field(1, "x", Type::Double, ""), field(2, "y", Type::Float, "")]);
    let state = message(
        "State",
        vec![
            field(1, "time", Type::Message, ".google.protobuf.Timestamp"),
            field(2, "rate", Type::Message, ".drone.Vector"),
            field(3, "rotors", Type::Message, ".drone.Vector"),
            field(4, "armed", Type::Bool, ""),
            field(5, "counts", Type::Sint64, ""),
            field(6, "mode", Type::Enum, ".drone.Mode"),
            field(7, "label", Type::String, ""),
            field(8, "accel", Type::Message, ".drone.Vector"),
        ],
    );
    let mut drone = file("drone", &["google.protobuf.proto"], vec![vector, state]);
    let value = |name: &str, number| EnumValueDescriptorProto {
        name: Some(name.into()),
        number: Some(number),
        ..Default::default()
    };
    drone.enum_type.push(EnumDescriptorProto {
        name: Some("Mode".into()),
        value: vec![value("OFF", 0), value("ACRO", 3)],
        ..Default::default()
    });
    FileDescriptorSet { file: vec![timestamp, drone] }
}

pub fn protobuf() -> Vec<u8> {
    let set = descriptors();
    let pool = DescriptorPool::from_file_descriptor_set(set.clone()).unwrap();
    let of = |name: &str, fields: &[(&str, Value)]| {
        let mut message = DynamicMessage::new(pool.get_message_by_name(name).unwrap());
        for (name, value) in fields {
            message.set_field_by_name(name, value.clone());
        }
        Value::Message(message)
    };
    let vector = |x, y| of("drone.Vector", &[("x", Value::F64(x)), ("y", Value::F32(y))]);
    let time = of("google.protobuf.Timestamp", &[("seconds", Value::I64(4)), ("nanos", Value::I32(750_000_000))]);
    let full = of(
        "drone.State",
        &[
            ("time", time),
            ("rate", vector(0.0, -1.5)),
            ("rotors", Value::List(vec![vector(1.0, 0.0), vector(2.0, 0.0)])),
            ("armed", Value::Bool(true)),
            ("counts", Value::List(vec![Value::I64(-5), Value::I64(6)])),
            ("mode", Value::EnumNumber(3)),
            ("label", Value::String("a".into())),
        ],
    );
    let messages = [full, of("drone.State", &[])].map(|message| message.as_message().unwrap().encode_to_vec());
    file("protobuf", Some(("drone.State", "protobuf", &set.encode_to_vec())), &messages)
}

#[test]
fn protobuf_is_read_by_its_descriptors() {
    let table = table(&protobuf());
    let nan = f64::NAN;
    let expected = [
        ("time", [4.75, nan]),
        // Zeros are not transmitted, neither within a vector that is there nor without presence.
        ("rate.x", [0.0, nan]),
        ("rate.y", [-1.5, nan]),
        ("rotors[0].x", [1.0, nan]),
        ("rotors[1].x", [2.0, nan]),
        ("armed", [1.0, 0.0]),
        ("counts[0]", [-5.0, nan]),
        ("counts[1]", [6.0, nan]),
        ("mode", [3.0, 0.0]),
    ];
    for (path, expected) in expected {
        let column = table.columns.get(path).unwrap_or_else(|| panic!("{path} is missing"));
        assert_eq!(format!("{column:?}"), format!("{expected:?}"), "{path}");
    }
    assert!(!table.columns.contains_key("accel.x"));
}

#[test]
fn what_cannot_be_decoded_names_topic_and_encoding() {
    let wide = ("p/msg/W", "ros2msg", b"wstring w".as_slice());
    let cases = [
        file("ros1", Some(("p/W", "ros1msg", b"int8 a")), &[vec![0]]),
        file("cdr", Some(wide), &[vec![0; 8]]),
        file("cdr", None, &[vec![0; 8]]),
        file("json", None, &[b"{".to_vec()]),
        file("protobuf", Some(("Missing", "protobuf", b"")), &[vec![]]),
        file("cdr", Some(("p/msg/A", "ros2msg", b"int8 a")), &[vec![0, 3, 0, 0, 0, 0]]),
    ];
    for (case, encoding) in cases.iter().zip(["ros1", "cdr", "cdr", "json", "protobuf", "cdr"]) {
        let text = tables(case, &|_| true).unwrap_err().to_string();
        assert!(text.contains("/t") && text.contains(encoding), "{text}");
        assert!(tables(case, &|_| false).is_ok());
    }
}

#[test]
fn the_vehicle_of_others_is_read_or_complained_about() {
    let with = |key: &str, value: &str| {
        let mut file = WriteOptions::new().create(Cursor::new(Vec::new())).unwrap();
        let metadata = BTreeMap::from([(key.to_string(), value.to_string())]);
        file.write_metadata(&Metadata { name: "racer.vehicle".into(), metadata }).unwrap();
        file.finish().unwrap();
        tables(&file.into_inner().into_inner(), &|_| true).map(|tables| tables.vehicle)
    };
    for rates in ["11.5 12 6.25", "[11.5, 12, 6.25]", "11.5,12,6.25"] {
        assert_eq!(with("max_rate_rad_s", rates).unwrap().max_rate_rad_s, Some([11.5, 12.0, 6.25]), "{rates}");
    }
    assert_eq!(with("mass_kg", "0.75").unwrap().mass_kg, Some(0.75));
    let wrong = [("mass_kg", "heavy"), ("mass_kg", "-1"), ("max_rate_rad_s", "1 2"), ("thrust_map", "-1..1 -> -1..1")];
    for (key, value) in wrong {
        let text = with(key, value).unwrap_err().to_string();
        assert!(text.contains(key) && text.contains(value), "{text}");
    }
}
