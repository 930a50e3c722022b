//! Fields of blackbox frames in physical units.

use super::header::Header;
use crate::base::check::BadInput;
use crate::flight::table::{LOG_TIME, Table};
use blackbox_log::frame::{Frame, FrameDef, GpsFrame, GpsFrameDef};
use std::collections::BTreeMap;

/// Fields that a flight may have been recorded without.
pub const STANDARD: [&str; 16] = [
    "setpoint[0]",
    "setpoint[1]",
    "setpoint[2]",
    "setpoint[3]",
    "gyroADC[0]",
    "gyroADC[1]",
    "gyroADC[2]",
    "accSmooth[0]",
    "accSmooth[1]",
    "accSmooth[2]",
    "motor[0]",
    "motor[1]",
    "motor[2]",
    "motor[3]",
    "vbatLatest",
    "amperageLatest",
];

/// Columns of the table "gps" beside its fields: metres from the first fix.
pub const PLANE: [&str; 2] = ["east", "north"];

/// A field that is read: scale (x - zero), where x is what was recorded.
pub struct Field {
    name: String,
    /// Its place in the frame; `None` where it was not recorded.
    index: Option<usize>,
    signed: bool,
    zero: f64,
    scale: f64,
}

impl Field {
    pub fn absent(name: &str) -> Self {
        Self { name: name.into(), index: None, signed: false, zero: 0.0, scale: 1.0 }
    }

    /// Fails where the header lacks the scale that the field needs.
    pub fn new(name: &str, index: usize, signed: bool, header: &Header, place: &str) -> Result<Self, BadInput> {
        let (zero, scale) = match name.split('[').next().unwrap_or(name) {
            "setpoint" if name == "setpoint[3]" => (0.0, 1e-3),
            "setpoint" => (0.0, 1f64.to_radians()),
            "gyroADC" | "gyroUnfilt" => (0.0, header.gyro_scale_rad_s(place)?),
            "accSmooth" => (0.0, header.acceleration_scale_m_s2(place)?),
            "vbatLatest" | "amperageLatest" => (0.0, 1e-2),
            "motor" => header.motor_range(place).map(|[low, high]| (low, 1.0 / (high - low)))?,
            "GPS_coord" => (0.0, 1e-7),
            "GPS_speed" => (0.0, 1e-2),
            "GPS_ground_course" => (0.0, 0.1),
            "GPS_altitude" => (0.0, header.altitude_scale_m()),
            _ => (0.0, 1.0),
        };
        Ok(Self { name: name.into(), index: Some(index), signed, zero, scale })
    }

    fn value(&self, frame: &impl Frame) -> f64 {
        let Some(raw) = self.index.and_then(|index| frame.get_raw(index)) else { return f64::NAN };
        let x = if self.signed { f64::from(raw.cast_signed()) } else { f64::from(raw) };
        self.scale * (x - self.zero)
    }
}

/// Rows of a table that grows.
pub struct Rows {
    time_s: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

impl Rows {
    pub fn new(fields: &[Field]) -> Self {
        Self { time_s: Vec::new(), columns: vec![Vec::new(); fields.len()] }
    }

    pub fn push(&mut self, time_us: u64, fields: &[Field], frame: &impl Frame) {
        self.time_s.push(time_us as f64 * 1e-6);
        for (column, field) in self.columns.iter_mut().zip(fields) {
            column.push(field.value(frame));
        }
    }

    /// From the first row to the last.
    pub fn span_s(&self) -> f64 {
        self.time_s.last().zip(self.time_s.first()).map_or(0.0, |(last, first)| last - first)
    }

    pub fn table(self, fields: &[Field]) -> Table {
        let mut columns: BTreeMap<_, _> = fields.iter().map(|field| field.name.clone()).zip(self.columns).collect();
        columns.insert(LOG_TIME.into(), self.time_s);
        Table { columns }
    }
}

/// Latitude and longitude of GPS frames, as metres east and north of the first fix.
pub struct Plane {
    index: Option<[usize; 2]>,
    first: Option<[f64; 2]>,
    pub east: Vec<f64>,
    pub north: Vec<f64>,
}

impl Plane {
    pub fn new(def: &GpsFrameDef) -> Self {
        let place = |name| def.iter().position(|field| field.name == name);
        let index = place("GPS_coord[0]").zip(place("GPS_coord[1]")).map(|(latitude, longitude)| [latitude, longitude]);
        Self { index, first: None, east: Vec::new(), north: Vec::new() }
    }

    pub fn push(&mut self, frame: &GpsFrame) {
        let degrees = |index| frame.get_raw(index).map_or(f64::NAN, |raw| 1e-7 * f64::from(raw.cast_signed()));
        let [latitude, longitude] = self.index.map_or([f64::NAN; 2], |index| index.map(degrees));
        let [latitude_0, longitude_0] = *self.first.get_or_insert([latitude, longitude]);
        /// Metres a degree of latitude, on a sphere.
        const METRES: f64 = 6_371_008.8 * std::f64::consts::PI / 180.0;
        self.east.push(METRES * (longitude - longitude_0) * latitude_0.to_radians().cos());
        self.north.push(METRES * (latitude - latitude_0));
    }
}
