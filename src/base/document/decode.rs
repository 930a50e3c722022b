//! From a TOML table to a struct, with serde's complaints taken apart into key, expected and found.

use super::nearest;
use crate::base::check::Invalid;
use serde::de::DeserializeOwned;

/// Decodes `table`. Fails on unknown and missing keys and wrong types.
pub fn decode<T: DeserializeOwned>(table: toml::Table) -> Result<T, Invalid> {
    serde_path_to_error::deserialize(toml::Value::Table(table)).map_err(|error| {
        let key = match error.path().to_string() {
            path if path == "." => String::new(),
            path => path,
        };
        explain(key, error.into_inner().message())
    })
}

fn explain(key: String, message: &str) -> Invalid {
    if let Some(rest) = message.strip_prefix("unknown field ") {
        let (found, known) = rest.split_once(", ").unwrap_or((rest, ""));
        let mut known = quoted(known);
        let advice = match nearest(found.trim_matches('`'), known.iter().copied()) {
            Some(name) => format!("did you mean `{name}`?"),
            None => "remove it".into(),
        };
        known.sort_unstable();
        return Invalid::new(&key, "an unknown key", &format!("one of {}", known.join(", ")), &advice);
    }
    if let Some(rest) = message.strip_prefix("missing field ") {
        let missing = Invalid::new(rest.trim_matches('`'), "nothing", "a value", "add the key");
        return if key.is_empty() { missing } else { missing.within(&key) };
    }
    if let Some((found, expected)) = message.split_once(", expected ") {
        let found = found.trim_start_matches("invalid type: ").trim_start_matches("invalid value: ");
        return Invalid::new(&key, found, &plain(expected), "");
    }
    Invalid::new(&key, message, "", "")
}

/// Rust's type names in words.
fn plain(expected: &str) -> String {
    match expected {
        "f64" | "f32" => "a number",
        "u64" | "u32" | "usize" => "a whole number, zero or more",
        "i64" => "a whole number",
        other if other.starts_with("struct ") => "a table",
        other => other,
    }
    .into()
}

/// The words between backticks.
fn quoted(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct Outer {
        inner: Vec<Inner>,
    }

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct Inner {
        radius: f64,
        count: usize,
    }

    fn complaint(text: &str) -> Invalid {
        decode::<Outer>(text.parse().unwrap()).unwrap_err()
    }

    #[test]
    fn complaints_name_the_key_and_both_sides() {
        let unknown = complaint("inner = [{radius = 1, count = 2, raduis = 3}]");
        assert_eq!((unknown.key.as_str(), unknown.advice.as_str()), ("inner[0].raduis", "did you mean `radius`?"));
        let missing = complaint("inner = [{radius = 1}]");
        assert_eq!((missing.key.as_str(), missing.found.as_str()), ("inner[0].count", "nothing"));
        let kind = complaint("inner = [{radius = 'wide', count = 2}]");
        assert_eq!((kind.key.as_str(), kind.expected.as_str()), ("inner[0].radius", "a number"));
        assert_eq!(kind.found, "string \"wide\"");
        let negative = complaint("inner = [{radius = 1, count = -2}]");
        assert_eq!((negative.key.as_str(), negative.found.as_str()), ("inner[0].count", "integer `-2`"));
    }
}
