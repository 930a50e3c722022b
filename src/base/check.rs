//! What a setting must satisfy, and how a setting that does not is reported.

use std::fmt::Display;

/// A struct that a file sets, and that can say whether its values make sense together.
pub trait Check {
    /// The first value found wanting, its key relative to this struct.
    fn check(&self) -> Result<(), Invalid>;
}

/// A value out of range. Keys are relative to the struct that found it; every struct around it adds its own part.
#[derive(Clone, Debug, PartialEq)]
pub struct Invalid {
    /// Dotted key, such as `reward.gate` or `gates[3].radius_m`.
    pub key: String,
    pub found: String,
    pub expected: String,
    /// What to do about it; may be empty.
    pub advice: String,
}

impl Invalid {
    pub fn new(key: &str, found: impl Display, expected: &str, advice: &str) -> Self {
        Self { key: key.into(), found: found.to_string(), expected: expected.into(), advice: advice.into() }
    }

    /// Fine if `ok`, else the complaint that the other arguments describe.
    pub fn unless(ok: bool, key: &str, found: impl Display, expected: &str, advice: &str) -> Result<(), Self> {
        if ok { Ok(()) } else { Err(Self::new(key, found, expected, advice)) }
    }

    /// `value` must be a finite number above zero.
    pub fn unless_positive(key: &str, value: f64, advice: &str) -> Result<(), Self> {
        Self::unless(value.is_finite() && value > 0.0, key, value, "a number above 0", advice)
    }

    /// `value` must be a finite number, zero or more.
    pub fn unless_not_negative(key: &str, value: f64, advice: &str) -> Result<(), Self> {
        Self::unless(value.is_finite() && value >= 0.0, key, value, "zero or more", advice)
    }

    /// `range` must be `[low, high]` with `least <= low <= high`, both finite.
    pub fn unless_range(key: &str, range: [f64; 2], least: f64, advice: &str) -> Result<(), Self> {
        let [low, high] = range;
        let ok = low.is_finite() && high.is_finite() && least <= low && low <= high;
        let expected = format!("[low, high] with {least} <= low <= high");
        Self::unless(ok, key, format!("[{low}, {high}]"), &expected, advice)
    }

    /// The same complaint seen from the struct around: `rate` within `ppo` is `ppo.rate`.
    pub fn within(mut self, outer: &str) -> Self {
        self.key = match self.key.as_str() {
            "" => outer.into(),
            key => format!("{outer}.{key}"),
        };
        self
    }
}

/// Input from the user that cannot be used, with everything needed to mend it. Becomes exit code 2.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", self.text())]
pub struct BadInput {
    /// File and line, or the command-line option.
    pub place: String,
    /// Dotted key in that file; empty where there is none.
    pub key: String,
    /// What was found there.
    pub found: String,
    /// What would be right.
    pub expected: String,
    /// What to do about it; may be empty.
    pub advice: String,
}

impl BadInput {
    /// Input that is not a key of a file.
    pub fn new(place: impl Display, found: impl Display, expected: &str, advice: impl Display) -> Self {
        Self {
            place: place.to_string(),
            key: String::new(),
            found: found.to_string(),
            expected: expected.into(),
            advice: advice.to_string(),
        }
    }

    /// `invalid` found at `place`.
    pub fn at(place: impl Display, invalid: Invalid) -> Self {
        let Invalid { key, found, expected, advice } = invalid;
        Self { place: place.to_string(), key, found, expected, advice }
    }

    fn text(&self) -> String {
        let mut text = self.place.clone();
        if !self.key.is_empty() {
            text += &format!(": {}", self.key);
        }
        for (label, value) in [("expected", &self.expected), ("found", &self.found), ("to do", &self.advice)] {
            if !value.is_empty() {
                text += &format!("\n  {label:<9} {value}");
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_grow_outwards_and_the_text_names_everything() {
        let invalid = Invalid::unless_positive("gate", -1.0, "raise it").unwrap_err().within("reward").within("env");
        assert_eq!(invalid.key, "env.reward.gate");
        let text = BadInput::at("a.toml:7", invalid).to_string();
        for part in ["a.toml:7", "env.reward.gate", "a number above 0", "-1", "raise it"] {
            assert!(text.contains(part), "{text}");
        }
    }

    #[test]
    fn not_a_number_is_never_in_range() {
        assert!(Invalid::unless_positive("x", f64::NAN, "").is_err());
        assert!(Invalid::unless_not_negative("x", f64::INFINITY, "").is_err());
        assert!(Invalid::unless_range("x", [f64::NAN, 1.0], 0.0, "").is_err());
        assert!(Invalid::unless_range("x", [1.0, 0.5], 0.0, "").is_err());
    }
}
