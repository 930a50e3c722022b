//! The CSV files that `blackbox_decode` writes, as the table "main" that the blackbox itself gives.

use super::fields::standard;
use super::fixes::Fixes;
use super::scales::motor_stop;
use crate::base::check::BadInput;
use crate::flight::Readable;
use crate::flight::csv::{self, files::Csv};
use crate::flight::format::{Content, Format, LogFile};
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

    fn recognises(&self, file: &LogFile) -> bool {
        let line = file.start().split(|&byte| byte == b'\n').next().unwrap_or_default();
        line.starts_with(b"loopIteration,") && line.windows(6).any(|window| window == b"time (")
    }

    fn mapping(&self, _: &LogFile) -> Result<(&'static str, Option<String>), BadInput> {
        Ok(("betaflight", Some("its columns are those of blackbox_decode".into())))
    }

    fn tables(&self, file: &LogFile, mapping: &Mapping) -> Result<Content, BadInput> {
        if !mapping.sources().contains("main") {
            // Somebody's own mapping, for its columns as they are.
            return Csv.tables(file, mapping);
        }
        let header = csv::header(file.bytes, file.name)?;
        let numbers = header.iter().map(String::as_str).filter(|name| scale(name).is_some()).collect();
        let (table, readable) = csv::table(file.bytes, file.name, &numbers)?;
        let (mut tables, remarks) = tables(table, readable);
        if let Some(gps) = beside(file)? {
            tables.tables.insert("gps".into(), gps);
        }
        Ok(Content { tables, remarks, flights: Vec::new() })
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
    remarks.extend(scale_motors(&mut main));
    for name in standard() {
        main.columns.entry(name).or_insert_with(|| vec![f64::NAN; rows]);
    }
    (Tables { tables: [("main".to_string(), main)].into(), readable, ..Tables::default() }, remarks)
}

/// The GPS frames, which blackbox_decode writes to a file of their own.
fn beside(file: &LogFile) -> Result<Option<Table>, BadInput> {
    let path = file.path.with_extension("gps.csv");
    if !file.ends(&[".csv"]) || !path.is_file() {
        return Ok(None);
    }
    let name = path.display().to_string();
    let bytes = std::fs::read(&path).map_err(|error| BadInput::new(&name, error, "a CSV file", ""))?;
    let header = csv::header(&bytes, &name)?;
    let (table, _) = csv::table(&bytes, &name, &header.iter().map(String::as_str).collect())?;
    let rows = table.rows();
    let column = |field: &str, scale: f64| {
        let named = table.columns.iter().find(|(name, _)| name.split(" (").next() == Some(field));
        named.map_or(vec![f64::NAN; rows], |(_, values)| values.iter().map(|value| scale * value).collect())
    };
    let fixes = Fixes {
        time_s: column("time", 1e-6),
        latitude: column("GPS_coord[0]", 1.0),
        longitude: column("GPS_coord[1]", 1.0),
        // Betaflight's decimetres, which the decoder leaves as they are.
        altitude_m: column("GPS_altitude", 0.1),
        speed_m_s: column("GPS_speed", 1.0),
        course: column("GPS_ground_course", 1.0),
        velocity_m_s: vec![[f64::NAN; 3]; rows],
    };
    let mut gps = Table::default();
    fixes.add_to(&mut gps);
    gps.columns.insert("GPS_altitude".into(), fixes.altitude_m);
    gps.columns.insert(LOG_TIME.into(), fixes.time_s);
    Ok(Some(gps))
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
        ("motor", "") => (1.0, true),
        ("vbatLatest", "V") => (1.0, false),
        ("vbatLatest", "mV") => (1e-3, false),
        _ => return None,
    })
}

/// Makes motor outputs shares of the full command, by the smallest of them.
fn scale_motors(main: &mut Table) -> Option<String> {
    let outputs = || main.columns.iter().filter(|(name, _)| name.starts_with("motor[")).flat_map(|(_, values)| values);
    let least = outputs().copied().filter(|output| *output > 0.0).fold(f64::INFINITY, f64::min);
    if least.is_infinite() {
        return None;
    }
    let stop = motor_stop(least);
    let full = if stop < 1000.0 { 2047.0 } else { 2000.0 };
    for (_, values) in main.columns.iter_mut().filter(|(name, _)| name.starts_with("motor[")) {
        values.iter_mut().for_each(|output| *output = ((*output - stop) / (full - stop)).max(0.0));
    }
    Some(format!("`motor` is taken for {stop} to {full}, as its header would say: better read the blackbox"))
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
