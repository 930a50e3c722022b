//! Values of options that several commands have.

use crate::base::threads::processors;

/// The value of `--threads`.
pub fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 1..=1024) => Ok(threads),
        _ => Err("expected 1 to 1024".into()),
    }
}

/// The threads that were asked for, or all processors.
pub fn threads(asked: Option<usize>) -> usize {
    asked.unwrap_or_else(processors)
}

/// The length of a flight, s.
pub fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.1..=3600.0).contains(&seconds) => Ok(seconds),
        _ => Err("expected 0.1 to 3600".into()),
    }
}
