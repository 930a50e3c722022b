//! What a file holds before a mapping says what it means: tables of named columns.

use super::{Readable, VehicleRecord};
use std::collections::BTreeMap;

/// Column of the time at which a record was logged, where the format has one, s.
pub const LOG_TIME: &str = "@log_time";

/// Rows of one topic, message type or CSV file. Every column has one number for each row; NaN where a row lacks it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Field path such as `angular_velocity.x` or `pose.pose.position.z` or `velocity[2]`, to values. Times
    /// (`header.stamp`, a builtin time) are seconds.
    pub columns: BTreeMap<String, Vec<f64>>,
}

impl Table {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.values().next().map_or(0, Vec::len)
    }
}

/// A file, read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tables {
    /// By topic; the one table of a CSV file is called "".
    pub tables: BTreeMap<String, Table>,
    /// The metadata record `racer.vehicle`, or what the format says about the vehicle.
    pub vehicle: VehicleRecord,
    pub readable: Readable,
}
