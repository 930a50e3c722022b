//! Values as text: JSON, TOML and CSV, with the library's own error.

use crate::base::error::{Error, Result};
use serde::Serialize;

/// `value` as JSON that people can read, with a newline at its end. `what` names it in the error.
pub fn json(what: &'static str, value: &impl Serialize) -> Result<String> {
    Ok(serde_json::to_string_pretty(value).map_err(Error::encode(what))? + "\n")
}

/// `value` as TOML.
pub fn toml(what: &'static str, value: &impl Serialize) -> Result<String> {
    toml::to_string(value).map_err(Error::encode(what))
}

/// What `fill` writes, as CSV.
pub fn csv(what: &'static str, fill: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> csv::Result<()>) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    fill(&mut writer).map_err(Error::encode(what))?;
    writer.into_inner().map_err(Error::encode(what))
}
