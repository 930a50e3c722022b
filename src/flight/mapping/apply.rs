//! From tables to a log.

use super::quantity::{Scalar, Time, Vector, signed};
use super::units::Unit;
use super::{Battery, Imu, Mapping, Odometry, Part, Rotors, Setpoint, VelocityFrame, frames, join};
use crate::check::BadInput;
use crate::document::nearest;
use crate::flight::table::{LOG_TIME, Table, Tables};
use crate::flight::{Log, Stream, VehicleRecord};

/// Time of a message that carries its own.
const STAMP: &str = "header.stamp";

impl Mapping {
    /// Reads the log that `tables`, of the file `name`, hold. Times are from the earliest of all streams on; rows without
    /// any value are left out. Fails where a source or a column is missing, naming the nearest.
    pub fn apply(&self, tables: &Tables, name: &str) -> Result<Log, BadInput> {
        let reader = Reader { mapping: self, tables, name };
        let mut log = Log {
            name: name.into(),
            setpoint: reader.stream("setpoint", &self.setpoint, setpoint)?,
            imu: reader.stream("imu", &self.imu, imu)?,
            odometry: reader.stream("odometry", &self.odometry, odometry)?,
            battery: reader.stream("battery", &self.battery, battery)?,
            rotors: reader.stream("rotors", &self.rotors, rotors)?,
            vehicle: self.record(&tables.vehicle),
            readable: tables.readable.clone(),
            ..Log::default()
        };
        if log.earliest().is_infinite() {
            return Err(reader.nothing());
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
        }
    }
}

impl Log {
    fn earliest(&self) -> f64 {
        [&self.setpoint.time_s, &self.imu.time_s, &self.odometry.time_s, &self.battery.time_s, &self.rotors.time_s]
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
        ];
        for time in streams.into_iter().flatten() {
            *time -= start;
        }
    }
}

/// What a part is read from.
struct Reader<'a> {
    mapping: &'a Mapping,
    tables: &'a Tables,
    name: &'a str,
}

/// A part of the mapping and its table.
struct Open<'a> {
    reader: &'a Reader<'a>,
    /// Key of the part in the mapping.
    key: &'a str,
    source: &'a str,
    table: &'a Table,
    stamps: Vec<f64>,
}

enum Missing {
    Source(BadInput),
    Other(BadInput),
}

impl From<BadInput> for Missing {
    fn from(error: BadInput) -> Self {
        Missing::Other(error)
    }
}

impl<'a> Reader<'a> {
    /// The stream of the first alternative of `part` that the file has all of.
    fn stream<P: Part, const N: usize>(
        &self,
        key: &str,
        part: &Option<P>,
        read: fn(&P, &Open) -> Result<Vec<[f64; N]>, Missing>,
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

    fn open<'b, P: Part>(&'b self, key: &'b str, part: &'b P) -> Result<Open<'b>, Missing> {
        let origin = part.origin();
        let table = self.table(key, origin.source)?;
        let stamps = self.stamps(key, origin.source, table, origin.time)?;
        Ok(Open { reader: self, key, source: origin.source, table, stamps })
    }

    fn table(&self, key: &str, source: &str) -> Result<&'a Table, Missing> {
        self.tables.tables.get(source).ok_or_else(|| {
            let known: Vec<&str> = self.tables.tables.keys().map(String::as_str).collect();
            Missing::Source(BadInput::new(
                self.name,
                format!("no `{source}`"),
                &format!("the source of `{key}` in the mapping"),
                advice(source, &known),
            ))
        })
    }

    fn column(&self, key: &str, source: &str, table: &'a Table, name: &str) -> Result<&'a [f64], BadInput> {
        table.columns.get(name).map(Vec::as_slice).ok_or_else(|| {
            let known: Vec<&str> = table.columns.keys().map(String::as_str).collect();
            let of = if source.is_empty() { String::new() } else { format!(" in `{source}`") };
            BadInput::new(
                self.name,
                format!("no column `{name}`{of}"),
                &format!("the columns that `{key}` in the mapping names"),
                advice(name, &known),
            )
        })
    }

    /// When each row was measured, s.
    fn stamps(&self, key: &str, source: &str, table: &'a Table, time: Option<&Time>) -> Result<Vec<f64>, BadInput> {
        match time.or(self.mapping.time.as_ref()) {
            Some(Time { field, unit }) => {
                let column = self.column(&format!("{key}.time"), source, table, field)?;
                Ok(column.iter().map(|time| time * unit.factor()).collect())
            }
            None => {
                let name = if table.columns.contains_key(STAMP) { STAMP } else { LOG_TIME };
                match table.columns.get(name) {
                    Some(column) => Ok(column.clone()),
                    None => self.column(&format!("{key}.time"), source, table, "time").map(<[f64]>::to_vec),
                }
            }
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

    fn nothing(&self) -> BadInput {
        let wanted: Vec<_> = self.mapping.sources().into_iter().map(|source| format!("`{source}`")).collect();
        let known: Vec<&str> = self.tables.tables.keys().map(String::as_str).collect();
        let expected = match wanted.as_slice() {
            [one] if one == "``" => "rows with values".into(),
            _ => format!("values in any of {}", wanted.join(", ")),
        };
        let advice = format!("{}; `racer import --help` says how to write a mapping", advice("", &known));
        BadInput::new(self.name, "nothing of what the mapping names", &expected, advice)
    }
}

/// The nearest name, and those that there are.
fn advice(name: &str, known: &[&str]) -> String {
    /// More would only hide the rest of the message.
    const MOST: usize = 60;
    if known.is_empty() || known == [""] {
        return "is it the right file?".into();
    }
    let shown = known.iter().take(MOST).copied().collect::<Vec<_>>().join(", ");
    let more = if known.len() > MOST { format!(", and {} more", known.len() - MOST) } else { String::new() };
    match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? There are {shown}{more}"),
        None => format!("there are {shown}{more}"),
    }
}

impl Open<'_> {
    /// Rows of a quantity in SI; NaN where the mapping has none.
    fn vector<U: Unit, const N: usize>(
        &self,
        name: &str,
        quantity: &Option<Vector<U>>,
        sphere: bool,
    ) -> Result<Vec<[f64; N]>, Missing> {
        let Some(quantity) = quantity else { return Ok(vec![[f64::NAN; N]; self.table.len()]) };
        let key = format!("{}.{name}", self.key);
        let Some(source) = quantity.source.as_deref().filter(|&source| source != self.source) else {
            return self.own(&key, self.source, self.table, quantity);
        };
        let table = self.reader.table(&key, source)?;
        let rows = self.own(&key, source, table, quantity)?;
        let stamps = self.reader.stamps(&key, source, table, None)?;
        let at = |found: join::Between| join::blend(rows[found.before], rows[found.after], found.share, sphere);
        let found = join::between(&stamps, &self.stamps);
        Ok(found.into_iter().map(|found| found.map_or([f64::NAN; N], at)).collect())
    }

    fn own<U: Unit, const N: usize>(
        &self,
        key: &str,
        source: &str,
        table: &Table,
        quantity: &Vector<U>,
    ) -> Result<Vec<[f64; N]>, Missing> {
        let mut rows = vec![[f64::NAN; N]; table.len()];
        for (k, field) in quantity.fields.iter().enumerate().take(N) {
            let column = self.reader.column(&format!("{key}.fields"), source, table, signed(field).1)?;
            for (row, &x) in rows.iter_mut().zip(column) {
                row[k] = quantity.value(k, x);
            }
        }
        Ok(rows)
    }

    fn scalar<U: Unit>(&self, name: &str, quantity: &Option<Scalar<U>>) -> Result<Vec<f64>, Missing> {
        let Some(quantity) = quantity else { return Ok(vec![f64::NAN; self.table.len()]) };
        let key = format!("{}.{name}", self.key);
        let mut columns = Vec::new();
        for field in quantity.fields() {
            columns.push(self.reader.column(&key, self.source, self.table, signed(field).1)?);
        }
        Ok((0..self.table.len()).map(|i| quantity.value(columns.iter().map(|column| column[i]))).collect())
    }
}

fn setpoint(part: &Setpoint, open: &Open) -> Result<Vec<[f64; 4]>, Missing> {
    let body = part.body.unwrap_or(open.reader.mapping.body);
    let rates = open.vector::<_, 3>("rate", &part.rate, false)?;
    let thrust = open.scalar("thrust", &part.thrust)?;
    let row = |(rate, thrust)| {
        let [roll, pitch, yaw] = body.to_flu(rate);
        [roll, pitch, yaw, thrust]
    };
    Ok(rates.into_iter().zip(thrust).map(row).collect())
}

fn imu(part: &Imu, open: &Open) -> Result<Vec<[f64; 6]>, Missing> {
    let body = part.body.unwrap_or(open.reader.mapping.body);
    let turned = |vector| frames::mounted(part.rotation_deg, body.to_flu(vector));
    let gyro = open.vector("gyro", &part.gyro, false)?;
    let force = open.vector("specific_force", &part.specific_force, false)?;
    let row = |(gyro, force)| {
        let ([p, q, r], [x, y, z]) = (turned(gyro), turned(force));
        [p, q, r, x, y, z]
    };
    Ok(gyro.into_iter().zip(force).map(row).collect())
}

fn odometry(part: &Odometry, open: &Open) -> Result<Vec<[f64; 10]>, Missing> {
    let body = part.body.unwrap_or(open.reader.mapping.body);
    let world = part.world.unwrap_or(open.reader.mapping.world);
    let positions = open.vector("position", &part.position, false)?;
    let attitudes = open.vector("attitude", &part.attitude, true)?;
    let velocities = open.vector("velocity", &part.velocity, false)?;
    let row = |((position, attitude), velocity)| {
        let [x, y, z] = world.to_enu(position);
        let q @ [qw, qx, qy, qz] = frames::attitude(attitude, body, world);
        let [u, v, w] = match part.velocity_frame {
            VelocityFrame::Body => body.to_flu(velocity),
            VelocityFrame::World => frames::into_body(q, world.to_enu(velocity)),
        };
        [x, y, z, qw, qx, qy, qz, u, v, w]
    };
    Ok(positions.into_iter().zip(attitudes).zip(velocities).map(row).collect())
}

fn battery(part: &Battery, open: &Open) -> Result<Vec<[f64; 2]>, Missing> {
    let voltage = measured(open.scalar("voltage", &part.voltage)?);
    let current = measured(open.scalar("current", &part.current)?);
    Ok(voltage.into_iter().zip(current).map(|(voltage, current)| [voltage, current]).collect())
}

/// A flight controller without the sensor logs nothing but zeros.
fn measured(values: Vec<f64>) -> Vec<f64> {
    if values.iter().all(|&value| value == 0.0) { vec![f64::NAN; values.len()] } else { values }
}

fn rotors(part: &Rotors, open: &Open) -> Result<Vec<[f64; 4]>, Missing> {
    open.vector("speed", &part.speed, false)
}
