//! The CSV files that `blackbox_decode` writes, as the table "main" that the blackbox itself gives.

use super::fields::standard;
use crate::base::check::BadInput;
use crate::flight::Readable;
use crate::flight::csv::{self, files::Csv};
use crate::flight::format::{Content, File, Format};
use crate::flight::mapping::Mapping;
use crate::flight::table::{LOG_TIME, Table, Tables};
use std::f64::consts::PI;

const G_M_S2: f64 = 9.80665;

/// A blackbox that was made a CSV file.
pub struct Decoded;

impl Format for Decoded {
    fn name(&self) -> &'static str {
        "CSV of blackbox_decode"
    }

    fn recognises(&self, file: &File) -> bool {
        let line = file.start().split(|&byte| byte == b'\n').next().unwrap_or_default();
        line.starts_with(b"loopIteration,") && line.windows(6).any(|window| window == b"time (")
    }

    fn mapping(&self, _: &File) -> Result<(&'static str, Option<String>), BadInput> {
        Ok(("betaflight", Some("its columns are those of blackbox_decode".into())))
    }

    fn tables(&self, file: &File, mapping: &Mapping) -> Result<Content, BadInput> {
        if !mapping.sources().contains("main") {
            // Somebody's own mapping, for its columns as they are.
            return Csv.tables(file, mapping);
        }
        let header = csv::header(file.bytes, file.name)?;
        let numbers = header.iter().map(String::as_str).filter(|name| scale(name).is_some()).collect();
        let (table, readable) = csv::table(file.bytes, file.name, &numbers)?;
        let (tables, remarks) = tables(table, readable);
        Ok(Content { tables, remarks })
    }
}

/// The table by the units that its columns name, and what they leave uncertain.
fn tables(csv: Table, readable: Readable) -> (Tables, Vec<String>) {
    let rows = csv.columns.values().next().map_or(0, Vec::len);
    let mut main = Table::default();
    let mut remarks = Vec::new();
    for (name, values) in csv.columns {
        let Some((factor, sure)) = scale(&name) else { continue };
        let field = name.split(" (").next().unwrap_or_default();
        let field = if field == "time" { LOG_TIME } else { field };
        if !sure && !field.ends_with("[1]") && !field.ends_with("[2]") {
            remarks.push(format!("`{name}` is {}", uncertain(field)));
        }
        main.columns.insert(field.into(), values.into_iter().map(|value| factor * value).collect());
    }
    for name in standard() {
        main.columns.entry(name).or_insert_with(|| vec![f64::NAN; rows]);
    }
    (Tables { tables: [("main".to_string(), main)].into(), readable, ..Tables::default() }, remarks)
}

/// What makes a column of this name SI, and whether that is sure; `None` where it has no use or no known unit.
fn scale(name: &str) -> Option<(f64, bool)> {
    let (field, unit) = name.strip_suffix(')').and_then(|name| name.split_once(" (")).unwrap_or((name, ""));
    Some(match (field.split('[').next().unwrap_or_default(), unit) {
        ("time", "us") => (1e-6, true),
        ("time", "ms") => (1e-3, true),
        ("time", "s") | ("gyroADC", "rad/s") | ("accSmooth", "m/s2") | ("amperageLatest", "A") => (1.0, true),
        ("setpoint", _) if field == "setpoint[3]" => (1e-3, true),
        ("setpoint", _) | ("gyroADC", "deg/s") => (PI / 180.0, true),
        ("gyroADC", "") => (PI / 180.0, false),
        ("accSmooth", "g") => (G_M_S2, true),
        ("accSmooth", "") => (G_M_S2 / 2048.0, false),
        ("amperageLatest", "mA") => (1e-3, true),
        ("vbatLatest", "V") => (1.0, false),
        ("vbatLatest", "mV") => (1e-3, false),
        _ => return None,
    })
}

fn uncertain(field: &str) -> &'static str {
    match field {
        "vbatLatest" => {
            "converted by firmware version, wrongly for some: compare it with the battery, or read the blackbox"
        }
        "accSmooth[0]" => "taken for 2048 counts a g, which its header would say: better read the blackbox",
        _ => "taken for deg/s, as all firmware since 2017 logs it",
    }
}
