//! From tables to a log.

use super::source::{Missing, Open, Rows, Sources, advice};
use super::{Mapping, Part, streams};
use crate::base::check::BadInput;
use crate::flight::table::Tables;
use crate::flight::{Log, Stream, VehicleRecord};

impl Mapping {
    /// Reads the log that `tables`, of the file `name`, hold. Times are from the earliest of all streams on; rows
    /// without any value are left out. Fails where a source or a column is missing, naming the nearest.
    pub fn apply(&self, tables: &Tables, name: &str) -> Result<Log, BadInput> {
        let sources = Sources { mapping: self, tables, name };
        let mut log = Log {
            name: name.into(),
            setpoint: sources.stream("setpoint", &self.setpoint, streams::setpoint)?,
            imu: sources.stream("imu", &self.imu, streams::imu)?,
            odometry: sources.stream("odometry", &self.odometry, streams::odometry)?,
            battery: sources.stream("battery", &self.battery, streams::battery)?,
            rotors: sources.stream("rotors", &self.rotors, streams::rotors)?,
            motors: sources.stream("motors", &self.motors, streams::motors)?,
            states: sources.states()?,
            vehicle: self.record(&tables.vehicle),
            readable: tables.readable.clone(),
            ..Log::default()
        };
        if log.earliest().is_infinite() {
            return Err(sources.nothing());
        }
        log.start();
        Ok(log)
    }

    /// What is known of the vehicle; the file's own record wins.
    fn record(&self, file: &VehicleRecord) -> VehicleRecord {
        let max_rate = self.vehicle.max_rate_deg_s.map(|rates| rates.map(f64::to_radians));
        VehicleRecord {
            mass_kg: file.mass_kg.or(self.vehicle.mass_kg),
            max_rate_rad_s: file.max_rate_rad_s.or(max_rate),
            kind: file.kind.or(self.vehicle.kind),
            rotors: file.rotors.or(self.vehicle.rotors),
        }
    }
}

impl Log {
    fn earliest(&self) -> f64 {
        [
            &self.setpoint.time_s,
            &self.imu.time_s,
            &self.odometry.time_s,
            &self.battery.time_s,
            &self.rotors.time_s,
            &self.motors.time_s,
            &self.states.time_s,
        ]
        .into_iter()
        .flatten()
        .fold(f64::INFINITY, |earliest, &time| earliest.min(time))
    }

    /// Makes times relative to the earliest.
    fn start(&mut self) {
        let start = self.earliest();
        self.start_ns = (start * 1e9).round() as u64;
        let streams = [
            &mut self.setpoint.time_s,
            &mut self.imu.time_s,
            &mut self.odometry.time_s,
            &mut self.battery.time_s,
            &mut self.rotors.time_s,
            &mut self.motors.time_s,
            &mut self.states.time_s,
        ];
        for time in streams.into_iter().flatten() {
            *time -= start;
        }
    }
}

impl Sources<'_> {
    /// The stream of the first alternative of `part` that the file has all of.
    fn stream<P: Part, const N: usize>(
        &self,
        key: &str,
        part: &Option<P>,
        read: fn(&P, &Open) -> Rows<N>,
    ) -> Result<Stream<N>, BadInput> {
        let optional = part.as_ref().is_some_and(|part| part.origin().optional);
        let (mut next, mut missing) = (part.as_ref(), None);
        while let Some(part) = next {
            match self.open(key, part).and_then(|open| Ok((read(part, &open)?, open))) {
                Ok((rows, open)) => return self.rows(key, open.stamps, rows),
                // What a present source lacks says more than that another is absent.
                Err(Missing::Other(error)) if !matches!(missing, Some(Missing::Other(_))) => {
                    missing = Some(Missing::Other(error));
                }
                Err(error) => missing = missing.or(Some(error)),
            }
            next = part.otherwise();
        }
        match missing {
            Some(Missing::Source(_)) if optional => Ok(Stream::default()),
            Some(Missing::Source(error) | Missing::Other(error)) => Err(error),
            None => Ok(Stream::default()),
        }
    }

    /// Leaves out rows without values. Fails on values without a time.
    fn rows<const N: usize>(&self, key: &str, stamps: Vec<f64>, rows: Vec<[f64; N]>) -> Result<Stream<N>, BadInput> {
        let mut stream = Stream::default();
        for (i, (time, row)) in stamps.into_iter().zip(rows).enumerate() {
            if row.iter().all(|value| value.is_nan()) {
                continue;
            }
            if !time.is_finite() {
                let found = format!("row {} of `{key}` at time {time}", i + 1);
                let advice = "check the mapping's time, or remove the row";
                return Err(BadInput::new(self.name, found, "a time for every row", advice));
            }
            stream.push(time, row);
        }
        Ok(stream)
    }

    /// The complaint where no stream has a row.
    fn nothing(&self) -> BadInput {
        if self.tables.tables.values().all(|table| table.rows() == 0) && self.tables.tables.contains_key("") {
            let advice = "did the recording break off, or its conversion? Record or convert it again, or give another";
            let found = "names of columns, and no row below them";
            return BadInput::new(self.name, found, "a row for each time of the flight", advice);
        }
        let place = |source: &&str| if source.is_empty() { "its own columns".into() } else { format!("`{source}`") };
        let wanted: Vec<String> = self.mapping.sources().iter().map(place).collect();
        let known: Vec<&str> = self.tables.tables.keys().map(String::as_str).collect();
        let expected = format!("values in {}", wanted.join(" or "));
        let advice = format!("{}; `racer import --help` says how to write a mapping", advice("", &known));
        BadInput::new(self.name, "nothing of what the mapping names", &expected, advice)
    }
}
