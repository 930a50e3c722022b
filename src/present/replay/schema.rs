//! JSON schemas of messages, made from messages.

use serde_json::{Value, json};

/// The JSON schema of messages like `examples`: the types of everything that is in one of them.
pub fn schema(name: &str, examples: &[&Value]) -> Value {
    let mut schema = described(examples);
    if let Some(fields) = schema.as_object_mut() {
        fields.insert("title".into(), name.into());
        fields.insert("$schema".into(), "https://json-schema.org/draft/2020-12/schema".into());
    }
    schema
}

fn described(values: &[&Value]) -> Value {
    // Foxglove reads no lists of types, such as a number or null.
    let Some(first) = values.iter().find(|value| !value.is_null()) else { return json!({ "type": "number" }) };
    match first {
        Value::Object(fields) if fields.len() == 2 && fields.contains_key("nsec") => json!({
            "type": "object",
            "title": "time",
            "properties": {
                "sec": { "type": "integer", "minimum": 0 },
                "nsec": { "type": "integer", "minimum": 0, "maximum": 999_999_999 },
            },
        }),
        Value::Object(_) => {
            let mut fields: serde_json::Map<String, Value> = serde_json::Map::new();
            for name in values.iter().filter_map(|value| value.as_object()).flat_map(|object| object.keys()) {
                if !fields.contains_key(name) {
                    let all: Vec<&Value> = values.iter().filter_map(|value| value.get(name)).collect();
                    fields.insert(name.clone(), described(&all));
                }
            }
            json!({ "type": "object", "properties": fields })
        }
        Value::Array(_) => {
            let items: Vec<&Value> = values.iter().filter_map(|value| value.as_array()).flatten().collect();
            // Empty lists say nothing about what could be in them.
            let items =
                if items.is_empty() { json!({ "type": "object", "properties": {} }) } else { described(&items) };
            json!({ "type": "array", "items": items })
        }
        Value::String(_) => json!({ "type": "string" }),
        Value::Bool(_) => json!({ "type": "boolean" }),
        _ if values.iter().all(|value| value.is_i64() || value.is_u64()) => json!({ "type": "integer" }),
        _ => json!({ "type": "number" }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_examples_are_described() {
        let one = json!({ "at": { "sec": 1, "nsec": 2 }, "points": [], "x": null, "n": 1 });
        let other =
            json!({ "at": { "sec": 1, "nsec": 2 }, "points": [{ "y": 1 }, { "y": 0.5, "z": "a" }], "x": 1.5, "n": 2 });
        let schema = schema("example", &[&one, &other]);
        let fields = &schema["properties"];
        assert_eq!(fields["at"]["properties"]["nsec"]["type"], "integer");
        assert_eq!(fields["x"]["type"], "number");
        assert_eq!(fields["n"]["type"], "integer");
        let point = &fields["points"]["items"]["properties"];
        assert_eq!([&point["y"]["type"], &point["z"]["type"]], ["number", "string"]);
    }
}
