//! When the flight controller was armed.
//!
//! Firmware logs from arming on. That it is disarmed is told by an event, or by the switch of the flight modes.

use super::definition::FrameDefinition;
use super::event::{DISARM, Event};
use super::fields::GrowingRows;
use super::header::Header;
use crate::flight::table::Table;

/// The oldest Betaflight of which logs show that the first flight mode is being armed.
const MODES_SINCE: [u32; 2] = [3, 4];

pub struct Armed {
    /// Place of the flight modes in slow frames, where the first of them is being armed.
    modes: Option<usize>,
    now: Option<bool>,
    rows: GrowingRows,
}

impl Armed {
    pub fn new(slow: &FrameDefinition, header: &Header) -> Self {
        let place = || slow.names.iter().position(|name| name == "flightModeFlags");
        let modes = header.betaflight().filter(|version| *version >= MODES_SINCE).and_then(|_| place());
        Self { modes, now: None, rows: GrowingRows::new(1) }
    }

    fn set(&mut self, time_us: i64, armed: bool) {
        if self.now != Some(armed) {
            self.now = Some(armed);
            self.rows.push(time_us, [armed.into()]);
        }
    }

    /// A main frame was logged.
    pub fn begin(&mut self, time_us: i64) {
        if self.now.is_none() {
            self.set(time_us, true);
        }
    }

    pub fn slow(&mut self, time_us: i64, frame: &[i64]) {
        if let Some(index) = self.modes {
            self.set(time_us, frame[index] & 1 == 1);
        }
    }

    pub fn event(&mut self, time_us: i64, event: Event) {
        if event.kind == DISARM {
            self.set(time_us, false);
        }
    }

    /// Whether it was disarmed in the end.
    pub fn ended(&self) -> bool {
        self.now == Some(false)
    }

    /// With the one column "armed".
    pub fn table(self) -> Table {
        self.rows.table(["armed".to_string()])
    }
}
