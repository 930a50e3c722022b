//! Flight logs in racer's own terms: SI units, body frame front-left-up, world ENU with z up, one clock.
//!
//! A file is read into tables of named columns ([`table`]), and a mapping ([`mapping`]) says what the columns mean.

pub mod blackbox;
pub mod csv;
pub mod fly;
mod foreign;
mod format;
pub mod instruments;
pub mod live;
pub mod lowpass;
pub mod mapping;
pub mod mcap;
pub mod motors;
mod number;
pub mod open;
pub mod pilot;
pub mod planned;
pub mod rehearse;
pub mod sensors;
pub mod series;
pub mod spans;
pub mod table;
pub mod ulog;
pub mod vehicle;
pub mod write;

pub use format::FlightSummary;
pub use motors::MOTORS;
pub use open::{Options, open, open_with};
pub use vehicle::{VehicleKind, VehicleRecord};

use std::path::Path;

/// Numbers over time: row i was measured at `time_s[i]`. NaN stands for what was not measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stream<const N: usize> {
    /// Seconds since the start of the log, in the order of the file.
    pub time_s: Vec<f64>,
    /// The numbers of each time.
    pub rows: Vec<[f64; N]>,
}

impl<const N: usize> Stream<N> {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Adds a row.
    pub fn push(&mut self, time_s: f64, row: [f64; N]) {
        self.time_s.push(time_s);
        self.rows.push(row);
    }

    /// One number of every row.
    pub fn column(&self, k: usize) -> Vec<f64> {
        self.rows.iter().map(|row| row[k]).collect()
    }
}

/// One flight. A stream that the file lacks is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log {
    /// What it is called in messages: the path of the file.
    pub name: String,
    /// When the log starts, ns since 1970, or since the clock of the source started.
    pub start_ns: u64,
    /// Commands, as the controller received them: roll, pitch, yaw rate (rad/s), thrust (0..1).
    pub setpoint: Stream<4>,
    /// Body rates (rad/s) and specific force (m/s2), each along x, y, z.
    pub imu: Stream<6>,
    /// Position (m, world), attitude (body to world, w x y z), velocity (m/s, BODY frame).
    pub odometry: Stream<10>,
    /// Voltage (V) and current (A).
    pub battery: Stream<2>,
    /// Rotor speeds, rad/s; NaN beyond the rotors that the vehicle has.
    pub rotors: Stream<MOTORS>,
    /// What each motor was sent, as a share of the full command, 0..1; NaN beyond the motors that the vehicle has.
    pub motors: Stream<MOTORS>,
    /// Armed, and in the air: 1 or 0 from that time on until the next row; NaN where the log does not say.
    pub states: Stream<2>,
    /// What the file says about the vehicle.
    pub vehicle: VehicleRecord,
    /// What of the file could be read.
    pub readable: Readable,
}

impl Log {
    /// What a vehicle from it is called: the name of its file, without folder and endings.
    pub fn stem(&self) -> String {
        let name = Path::new(&self.name).file_name().unwrap_or_default().to_string_lossy();
        let packed = name.strip_suffix(".gz").unwrap_or(&name);
        Path::new(packed).file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }
}

/// How much of a file could be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Readable {
    /// All of it.
    #[default]
    Whole,
    /// The file breaks off, or turns bad, after so many of its bytes; what came before is in the log.
    Prefix {
        /// Bytes that could be read.
        bytes: u64,
        /// Bytes of the file.
        of: u64,
        /// What is wrong after them.
        why: String,
    },
}
