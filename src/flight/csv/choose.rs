//! The built-in mapping that a CSV file needs, told by its columns.

use crate::base::check::BadInput;
use crate::flight::mapping::{LIBRARY, Mapping};

/// The built-in mapping, the only one, all of whose columns there are. Fails otherwise, and says how near each came.
pub fn for_columns(header: &[String], name: &str) -> Result<&'static str, BadInput> {
    let mut fits = Vec::new();
    for (called, _) in LIBRARY.builtin {
        let mapping = Mapping::built_in(called)?;
        let columns = mapping.required();
        let wanted: Vec<_> = columns.iter().filter(|(source, _)| source.is_empty()).collect();
        let found = wanted.iter().filter(|(_, column)| header.iter().any(|name| name == column)).count();
        if !wanted.is_empty() {
            fits.push((*called, found, wanted.len()));
        }
    }
    let whole: Vec<_> = fits.iter().filter(|(_, found, of)| found == of).map(|(called, ..)| *called).collect();
    if let [one] = whole.as_slice() {
        return Ok(one);
    }
    let near: Vec<_> = fits.iter().map(|(called, found, of)| format!("{called} ({found} of {of} columns)")).collect();
    let advice = format!(
        "give --mapping: built in for CSV are {}; or a file of yours, see `racer import --help`. The columns are {}",
        near.join(", "),
        shown(header),
    );
    Err(BadInput::new(name, "columns that fit no built-in mapping", "a CSV file whose columns are known", advice))
}

fn shown(header: &[String]) -> String {
    /// More would only hide the rest of the message.
    const MOST: usize = 60;
    let names = header.iter().take(MOST).map(|name| name.chars().take(40).collect::<String>());
    let more = if header.len() > MOST { format!(", and {} more", header.len() - MOST) } else { String::new() };
    format!("{}{more}", names.collect::<Vec<_>>().join(", "))
}
