//! Fields of blackbox frames in physical units.

use super::definition::FrameDefinition;
use super::header::Header;
use crate::base::check::BadInput;
use crate::flight::table::{LOG_TIME, Table};
use std::collections::BTreeMap;

/// Fields that a flight may have been recorded without, and how many of each.
const STANDARD: [(&str, usize); 5] = [("setpoint", 4), ("gyroADC", 3), ("accSmooth", 3), ("motor", 1), ("eRPM", 1)];
const STANDARD_SINGLE: [&str; 2] = ["vbatLatest", "amperageLatest"];

/// Names of the fields that a flight may have been recorded without.
pub fn standard() -> impl Iterator<Item = String> {
    let numbered = |(of, count): (&'static str, usize)| (0..count).map(move |i| format!("{of}[{i}]"));
    STANDARD_SINGLE.into_iter().map(String::from).chain(STANDARD.into_iter().flat_map(numbered))
}

/// Whether a field is of a motor beyond the first, of which a vehicle may have fewer.
pub fn further_motor(name: &str) -> bool {
    (name.starts_with("motor[") || name.starts_with("eRPM[")) && !name.ends_with("[0]")
}

/// What INAV calls a field of Betaflight's with the same meaning and unit.
pub fn of_inav(name: &str) -> Option<&'static str> {
    Some(match name {
        "setpoint[0]" => "axisRate[0]",
        "setpoint[1]" => "axisRate[1]",
        "setpoint[2]" => "axisRate[2]",
        "vbatLatest" => "vbat",
        "amperageLatest" => "amperage",
        _ => return None,
    })
}

/// A field that is read: scale (x - zero), where x is what was recorded.
pub struct ScaledField {
    name: String,
    /// Its place in the frame; `None` where it was not recorded.
    index: Option<usize>,
    zero: f64,
    scale: f64,
    least: f64,
}

impl ScaledField {
    pub fn absent(name: &str) -> Self {
        Self { name: name.into(), index: None, zero: 0.0, scale: 1.0, least: f64::NEG_INFINITY }
    }

    /// Fails where the header lacks the scale that the field needs; motors and an accelerometer without one are absent.
    pub fn new(name: &str, index: usize, header: &Header, place: &str) -> Result<Self, BadInput> {
        let (zero, scale) = match name.split('[').next().unwrap_or(name) {
            "setpoint" if name == "setpoint[3]" => (0.0, 1e-3),
            "setpoint" => (0.0, 1f64.to_radians()),
            "gyroADC" | "gyroUnfilt" => (0.0, header.gyro_scale_rad_s(place)?),
            "accSmooth" => match header.acceleration_scale_m_s2(place)? {
                Some(scale) => (0.0, scale),
                None => return Ok(Self::absent(name)),
            },
            "vbatLatest" => (0.0, header.voltage_scale_v()),
            "amperageLatest" => (0.0, 1e-2),
            "motor" => match header.motor_range() {
                Some([stop, full]) => (stop, 1.0 / (full - stop)),
                None => return Ok(Self::absent(name)),
            },
            "eRPM" => match header.rotor_speed_scale_rad_s() {
                Some(scale) => (0.0, scale),
                None => return Ok(Self::absent(name)),
            },
            "GPS_coord" => (0.0, 1e-7),
            "GPS_speed" => (0.0, 1e-2),
            "GPS_ground_course" => (0.0, 0.1),
            "GPS_altitude" => (0.0, header.altitude_scale_m()),
            _ => (0.0, 1.0),
        };
        // A stopped motor is sent a number below the least command.
        let least = if name.starts_with("motor") { 0.0 } else { f64::NEG_INFINITY };
        Ok(Self { name: name.into(), index: Some(index), zero, scale, least })
    }

    fn value(&self, definition: &FrameDefinition, frame: &[i64]) -> f64 {
        let Some(index) = self.index else { return f64::NAN };
        (self.scale * (definition.number(index, frame[index]) as f64 - self.zero)).max(self.least)
    }
}

/// Rows of a table that grows.
pub struct GrowingRows {
    time_s: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

impl GrowingRows {
    pub fn new(columns: usize) -> Self {
        Self { time_s: Vec::new(), columns: vec![Vec::new(); columns] }
    }

    pub fn push(&mut self, time_us: i64, values: impl IntoIterator<Item = f64>) {
        self.time_s.push(time_us as f64 * 1e-6);
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(value);
        }
    }

    /// Time of the first row.
    pub fn start_s(&self) -> Option<f64> {
        self.time_s.first().copied()
    }

    /// From the first row to the last.
    pub fn span_s(&self) -> f64 {
        self.time_s.last().zip(self.time_s.first()).map_or(0.0, |(last, first)| last - first)
    }

    pub fn table(self, names: impl IntoIterator<Item = String>) -> Table {
        let mut columns: BTreeMap<_, _> = names.into_iter().zip(self.columns).collect();
        columns.insert(LOG_TIME.into(), self.time_s);
        Table { columns }
    }
}

/// The fields of one kind of frame, and their rows.
pub struct Recorded<'a> {
    definition: &'a FrameDefinition,
    fields: Vec<ScaledField>,
    pub rows: GrowingRows,
}

impl<'a> Recorded<'a> {
    pub fn new(definition: &'a FrameDefinition, fields: Vec<ScaledField>) -> Self {
        let rows = GrowingRows::new(fields.len());
        Self { definition, fields, rows }
    }

    pub fn push(&mut self, time_us: i64, frame: &[i64]) {
        self.rows.push(time_us, self.fields.iter().map(|field| field.value(self.definition, frame)));
    }

    pub fn table(self) -> Table {
        self.rows.table(self.fields.into_iter().map(|field| field.name))
    }
}
