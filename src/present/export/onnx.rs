//! An ONNX model: three pairs of Gemm and Tanh, and the rest of the policy's file as metadata.
//!
//! The messages are the part of `onnx.proto3` (github.com/onnx/onnx) that such a model needs, with its field numbers.

use super::{EXPORT, Exported};
use crate::learn::policy::ACTIONS;
use crate::race::env::observe::OBSERVATIONS;
use prost::Message;
use serde_json::Value;

#[derive(Clone, PartialEq, Message)]
struct ModelProto {
    #[prost(int64, tag = "1")]
    ir_version: i64,
    #[prost(string, tag = "2")]
    producer_name: String,
    #[prost(string, tag = "3")]
    producer_version: String,
    #[prost(string, tag = "6")]
    doc_string: String,
    #[prost(message, optional, tag = "7")]
    graph: Option<Graph>,
    #[prost(message, repeated, tag = "8")]
    opset_import: Vec<Operators>,
    #[prost(message, repeated, tag = "14")]
    metadata_props: Vec<Property>,
}

#[derive(Clone, PartialEq, Message)]
struct Operators {
    #[prost(int64, tag = "2")]
    version: i64,
}

#[derive(Clone, PartialEq, Message)]
struct Property {
    #[prost(string, tag = "1")]
    key: String,
    #[prost(string, tag = "2")]
    value: String,
}

#[derive(Clone, PartialEq, Message)]
struct Graph {
    #[prost(message, repeated, tag = "1")]
    node: Vec<NodeProto>,
    #[prost(string, tag = "2")]
    name: String,
    #[prost(message, repeated, tag = "5")]
    initializer: Vec<TensorProto>,
    #[prost(message, repeated, tag = "11")]
    input: Vec<ValueInfoProto>,
    #[prost(message, repeated, tag = "12")]
    output: Vec<ValueInfoProto>,
}

#[derive(Clone, PartialEq, Message)]
struct NodeProto {
    #[prost(string, repeated, tag = "1")]
    input: Vec<String>,
    #[prost(string, repeated, tag = "2")]
    output: Vec<String>,
    #[prost(string, tag = "3")]
    name: String,
    #[prost(string, tag = "4")]
    op_type: String,
}

/// `TensorProto`.
#[derive(Clone, PartialEq, Message)]
struct TensorProto {
    #[prost(int64, repeated, tag = "1")]
    dims: Vec<i64>,
    #[prost(int32, tag = "2")]
    data_type: i32,
    #[prost(string, tag = "8")]
    name: String,
    #[prost(bytes = "vec", tag = "9")]
    raw_data: Vec<u8>,
}

/// `ValueInfoProto`.
#[derive(Clone, PartialEq, Message)]
struct ValueInfoProto {
    #[prost(string, tag = "1")]
    name: String,
    #[prost(message, optional, tag = "2")]
    kind: Option<TypeProto>,
    #[prost(string, tag = "3")]
    doc_string: String,
}

/// `TypeProto`.
#[derive(Clone, PartialEq, Message)]
struct TypeProto {
    #[prost(message, optional, tag = "1")]
    tensor: Option<TensorTypeProto>,
}

#[derive(Clone, PartialEq, Message)]
struct TensorTypeProto {
    #[prost(int32, tag = "1")]
    elem_type: i32,
    #[prost(message, optional, tag = "2")]
    shape: Option<Sizes>,
}

#[derive(Clone, PartialEq, Message)]
struct Sizes {
    #[prost(message, repeated, tag = "1")]
    dim: Vec<DimensionProto>,
}

#[derive(Clone, PartialEq, Message)]
struct DimensionProto {
    #[prost(oneof = "OneSize", tags = "1, 2")]
    value: Option<OneSize>,
}

#[derive(Clone, PartialEq, prost::Oneof)]
enum OneSize {
    #[prost(int64, tag = "1")]
    Fixed(i64),
    #[prost(string, tag = "2")]
    Free(String),
}

/// `TensorProto.FLOAT`.
const FLOAT: i32 = 1;
/// Versions of the format (ONNX 1.10) and of the operators: old enough for every runtime in use.
const IR_VERSION: i64 = 8;
const OPERATORS: i64 = 13;

/// The model's bytes.
pub fn model(exported: &Exported) -> Vec<u8> {
    let metadata = &exported.metadata;
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), String::from);
    let property = |key: &str, value: String| Property { key: key.into(), value };
    let about = ["format", "racer", "flying", "training"].map(|key| property(key, text(&metadata[key])));
    let model = ModelProto {
        ir_version: IR_VERSION,
        producer_name: "racer".into(),
        producer_version: text(&metadata["racer"]),
        doc_string: format!(
            "A drone-racing policy for {} on {}, sha256 {}. The metadata `flying` says what goes in and out.",
            exported.snapshot.about.vehicle.name, exported.snapshot.about.track.name, exported.sha256
        ),
        graph: Some(graph(exported)),
        opset_import: vec![Operators { version: OPERATORS }],
        metadata_props: [property("export", EXPORT.into()), property("sha256", exported.sha256.clone())]
            .into_iter()
            .chain(about)
            .collect(),
    };
    model.encode_to_vec()
}

fn graph(exported: &Exported) -> Graph {
    let mut node = Vec::new();
    let mut initializer = Vec::new();
    for t in exported.content.tensors.iter().filter(|t| t.name.starts_with("actor.")) {
        let dims = t.shape.iter().map(|&n| n as i64).collect();
        initializer.push(TensorProto { dims, data_type: FLOAT, name: t.name.clone(), raw_data: t.bytes.clone() });
    }
    let mut from = "observation".to_string();
    for layer in 0..3 {
        let (sum, to) = (format!("sum_{layer}"), if layer == 2 { "action".into() } else { format!("hidden_{layer}") });
        let of = |input: Vec<String>, output: &str, op: &str| NodeProto {
            input,
            output: vec![output.into()],
            name: format!("{op}_{layer}"),
            op_type: op.into(),
        };
        let weights = ["weight", "bias"].map(|part| format!("actor.{layer}.{part}"));
        node.push(of([vec![from], weights.to_vec()].concat(), &sum, "Gemm"));
        node.push(of(vec![sum.clone()], &to, "Tanh"));
        from = to;
    }
    let input = vec![named("observation", OBSERVATIONS, "scaled entries, as `flying.observation` describes them")];
    let output =
        vec![named("action", ACTIONS, "each in [-1, 1]; `flying.action` and `flying.setpoint` say what to do")];
    Graph { node, name: "policy".into(), initializer, input, output }
}

/// A table of any number of rows.
fn named(name: &str, columns: usize, doc: &str) -> ValueInfoProto {
    let rows = DimensionProto { value: Some(OneSize::Free("rows".into())) };
    let columns = DimensionProto { value: Some(OneSize::Fixed(columns as i64)) };
    let table = TensorTypeProto { elem_type: FLOAT, shape: Some(Sizes { dim: vec![rows, columns] }) };
    ValueInfoProto { name: name.into(), kind: Some(TypeProto { tensor: Some(table) }), doc_string: doc.into() }
}
