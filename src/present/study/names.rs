//! What settings and runs are called: short enough to read, plain enough for a file system.

use toml::Value;

/// Longest name before it is cut.
const LONGEST: usize = 120;

/// A value as people write it.
pub fn value(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(x) if *x != 0.0 && !(1e-4..1e9).contains(&x.abs()) => format!("{x:e}"),
        Value::Float(x) => x.to_string(),
        Value::Array(values) => format!("[{}]", values.iter().map(self::value).collect::<Vec<_>>().join(" ")),
        other => other.to_string(),
    }
}

/// The shortest end of each dotted key that no other of the keys shares: `ppo.epochs` becomes `epochs`.
pub fn short(keys: &[String]) -> Vec<String> {
    let last = |key: &str| key.rsplit('.').next().unwrap_or(key).to_string();
    let shared = |key: &str| keys.iter().filter(|other| last(other) == last(key)).count() > 1;
    keys.iter().map(|key| if shared(key) { key.clone() } else { last(key) }).collect()
}

/// Parts of a name put together and reduced to what every file system takes.
pub fn join(parts: &[String]) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "_-.=+,".contains(c) { c } else { '-' };
    let joined = parts.join(",");
    let name: String = joined.chars().map(plain).collect();
    let name = name.trim_matches(|c| c == '-' || c == '.').to_string();
    if name.len() <= LONGEST {
        return name;
    }
    // Names that differ only beyond the cut stay different.
    format!("{}-{:08x}", &name[..LONGEST], crc32c::crc32c(joined.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_short_plain_and_different() {
        let keys = ["ppo.epochs", "env.noise.position_m", "env.reset.position_m"].map(String::from);
        assert_eq!(short(&keys), ["epochs", "env.noise.position_m", "env.reset.position_m"]);
        let values = ["2.5e-5", "0.001", "4", "'a/b.toml'", "[0, 14.0]"].map(|text| value(&text.parse().unwrap()));
        assert_eq!(values, ["2.5e-5", "0.001", "4", "a/b.toml", "[0 14]"]);
        assert_eq!(join(&["epochs=4".into(), "track=a/b.toml".into()]), "epochs=4,track=a-b.toml");
        let long = |end: &str| join(&["x".repeat(200) + end]);
        assert!(long("a") != long("b") && long("a").len() < 140);
    }
}
