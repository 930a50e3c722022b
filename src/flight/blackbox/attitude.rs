//! The attitude that newer Betaflight logs, body front-left-up to world east-north-up.

use super::definition::FrameDefinition;
use super::fields::GrowingRows;
use crate::flight::table::Table;
use std::f64::consts::FRAC_1_SQRT_2;

/// Columns of the table "attitude".
const COLUMNS: [&str; 4] = ["qw", "qx", "qy", "qz"];

/// What a component of 1 is logged as.
const ONE: f64 = 32767.0;

pub struct Attitude {
    index: [usize; 3],
    rows: GrowingRows,
}

impl Attitude {
    /// `None` where it was not logged.
    pub fn new(definition: &FrameDefinition) -> Option<Self> {
        let place = |k: usize| {
            let name = format!("imuQuaternion[{k}]");
            definition.names.iter().position(|known| *known == name)
        };
        Some(Self { index: [place(0)?, place(1)?, place(2)?], rows: GrowingRows::new(COLUMNS.len()) })
    }

    /// Betaflight's world is north, west, up; its w, which is not logged, is not negative.
    pub fn push(&mut self, time_us: i64, definition: &FrameDefinition, frame: &[i64]) {
        let [x, y, z] = self.index.map(|index| definition.number(index, frame[index]) as f64 / ONE);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        // A quarter turn left about the vertical, from west to north.
        let turned = [w - z, x - y, y + x, z + w].map(|number| FRAC_1_SQRT_2 * number);
        self.rows.push(time_us, turned);
    }

    pub fn table(self) -> Table {
        self.rows.table(COLUMNS.map(String::from))
    }
}
