//! A value given on the command line in place of the configuration file's.

use crate::base::check::BadInput;

/// One key and its new value, and the option that gave it.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Dotted key, such as `ppo.learning_rate`.
    pub key: String,
    pub value: toml::Value,
    /// How the user wrote it, for messages.
    pub option: String,
}

impl Setting {
    /// Takes `key=value` apart. The value is TOML; what is not (a bare word) is taken as a string.
    pub fn parse(text: &str) -> Result<Self, BadInput> {
        let option = format!("--set {text}");
        let (key, value) = match text.split_once('=') {
            Some((key, value)) if !key.trim().is_empty() => (key.trim(), value.trim()),
            _ => {
                return Err(BadInput::new(
                    &option,
                    text,
                    "key=value",
                    "write for example --set ppo.learning_rate=3e-4",
                ));
            }
        };
        let value = value.parse().unwrap_or_else(|_| toml::Value::String(value.into()));
        Ok(Self { key: key.into(), value, option })
    }

    /// What an option of its own, such as `--seed 3`, sets.
    pub fn of(option: &str, key: &str, value: impl Into<toml::Value>) -> Self {
        let value = value.into();
        Self { key: key.into(), option: format!("{option} {value}"), value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_toml_or_words() {
        assert_eq!(Setting::parse("ppo.clip=0.1").unwrap().value, toml::Value::Float(0.1));
        assert_eq!(Setting::parse("seed = 4").unwrap().value, toml::Value::Integer(4));
        assert_eq!(Setting::parse("track=uzh_split_s").unwrap().value, toml::Value::String("uzh_split_s".into()));
        assert_eq!(Setting::parse("env.reset.speed_m_s=[0, 9.5]").unwrap().value.as_array().unwrap().len(), 2);
        for bad in ["seed", "=3", ""] {
            assert!(Setting::parse(bad).unwrap_err().to_string().contains("key=value"), "{bad}");
        }
    }
}
