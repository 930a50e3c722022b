//! What the columns of a file mean: which is which quantity, in which unit, with which sign, in which frame.

mod apply;
pub mod frames;
mod join;
mod parts;
mod quantity;
mod source;
mod states;
mod streams;
mod units;

pub use frames::{Body, VelocityFrame, World};
pub use parts::{BatteryPart, ImuPart, MotorsPart, OdometryPart, RotorsPart, SetpointPart, StatesPart};
pub use quantity::Time;

use crate::base::check::{BadInput, Check, Invalid};
use crate::base::document::Library;
use crate::flight::{MOTORS, VehicleKind};
use parts::Part;
use serde::Deserialize;
use std::collections::BTreeSet;

pub(super) const LIBRARY: Library = Library {
    kind: "mapping",
    folder: "configs/mappings",
    builtin: &[
        ("canonical", include_str!("../../configs/mappings/canonical.toml")),
        ("betaflight", include_str!("../../configs/mappings/betaflight.toml")),
        ("betaflight_csv", include_str!("../../configs/mappings/betaflight_csv.toml")),
        ("px4", include_str!("../../configs/mappings/px4.toml")),
        ("px4_ros2", include_str!("../../configs/mappings/px4_ros2.toml")),
        ("mavros", include_str!("../../configs/mappings/mavros.toml")),
        ("crazyflie", include_str!("../../configs/mappings/crazyflie.toml")),
        ("agilicious", include_str!("../../configs/mappings/agilicious.toml")),
        ("neurobem", include_str!("../../configs/mappings/neurobem.toml")),
        ("indiflight", include_str!("../../configs/mappings/indiflight.toml")),
        ("nanobench", include_str!("../../configs/mappings/nanobench.toml")),
    ],
};

/// How to read a [`Log`](super::Log) out of the tables of a file. A stream without its table here is empty.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// Frame of body vectors, where a stream does not say otherwise.
    #[serde(default)]
    pub body: Body,
    /// Frame of the world, where a stream does not say otherwise.
    #[serde(default)]
    pub world: World,
    /// Time of a row, where a stream does not say otherwise: `header.stamp` by default, or the time of logging.
    pub time: Option<Time>,
    pub setpoint: Option<SetpointPart>,
    pub imu: Option<ImuPart>,
    pub odometry: Option<OdometryPart>,
    pub battery: Option<BatteryPart>,
    pub rotors: Option<RotorsPart>,
    pub motors: Option<MotorsPart>,
    pub states: Option<StatesPart>,
    /// For files that do not say; what the file says wins.
    #[serde(default)]
    pub vehicle: VehicleFigures,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleFigures {
    pub mass_kg: Option<f64>,
    /// Body rates that a full stick asks for: roll, pitch, yaw.
    pub max_rate_deg_s: Option<[f64; 3]>,
    pub kind: Option<VehicleKind>,
    /// How many rotors carry it.
    pub rotors: Option<u8>,
}

impl Mapping {
    /// Reads a mapping by name or file.
    pub fn load(name: &str) -> Result<Self, BadInput> {
        LIBRARY.open(name)?.decode()
    }

    /// The built-in one of that name, whatever files there are.
    pub(super) fn built_in(name: &str) -> Result<Self, BadInput> {
        LIBRARY.built_in(name)?.decode()
    }

    /// Whether anything is read from this topic or table.
    pub fn wanted(&self, topic: &str) -> bool {
        self.sources().contains(topic)
    }

    /// All topics or tables that anything may be read from.
    pub fn sources(&self) -> BTreeSet<&str> {
        self.columns().into_iter().map(|(source, _)| source).collect()
    }

    /// All columns that may be read, each with its topic or table.
    pub fn columns(&self) -> BTreeSet<(&str, &str)> {
        self.fields().into_iter().map(|(source, field)| (source, quantity::column(field))).collect()
    }

    /// Those of them that a file may not lack.
    pub fn required(&self) -> BTreeSet<(&str, &str)> {
        let fields = self.fields().into_iter().filter(|(_, field)| !quantity::optional(field));
        fields.map(|(source, field)| (source, quantity::column(field))).collect()
    }

    /// All fields, as the mapping names them, each with its topic or table.
    fn fields(&self) -> BTreeSet<(&str, &str)> {
        let mut columns = BTreeSet::new();
        let time = self.time.as_ref();
        chain(&self.setpoint, time, &mut columns);
        chain(&self.imu, time, &mut columns);
        chain(&self.odometry, time, &mut columns);
        chain(&self.battery, time, &mut columns);
        chain(&self.rotors, time, &mut columns);
        chain(&self.motors, time, &mut columns);
        chain(&self.states, time, &mut columns);
        columns
    }
}

/// Adds the columns of a stream and of its alternatives.
fn chain<'a, P: Part>(part: &'a Option<P>, time: Option<&'a Time>, columns: &mut BTreeSet<(&'a str, &'a str)>) {
    let mut next = part.as_ref();
    while let Some(part) = next {
        let own = part.columns();
        columns.extend(time.iter().flat_map(|time| own.iter().map(|(source, _)| (*source, &*time.field))));
        columns.extend(own);
        next = part.otherwise();
    }
}

impl Check for Mapping {
    fn check(&self) -> Result<(), Invalid> {
        let some = self.setpoint.is_some()
            || self.imu.is_some()
            || self.odometry.is_some()
            || self.battery.is_some()
            || self.rotors.is_some()
            || self.motors.is_some()
            || self.states.is_some();
        let expected = "one of [setpoint], [imu], [odometry], [battery], [rotors], [motors], [states]";
        Invalid::unless(some, "", "no stream", expected, "")?;
        check("setpoint", &self.setpoint)?;
        check("imu", &self.imu)?;
        check("odometry", &self.odometry)?;
        check("battery", &self.battery)?;
        check("rotors", &self.rotors)?;
        check("motors", &self.motors)?;
        check("states", &self.states)?;
        if let Some(mass) = self.vehicle.mass_kg {
            Invalid::unless_positive("vehicle.mass_kg", mass, "leave it out where it is not known")?;
        }
        if let Some(rotors) = self.vehicle.rotors {
            let expected = format!("1 to {MOTORS}");
            Invalid::unless((1..=MOTORS).contains(&rotors.into()), "vehicle.rotors", rotors, &expected, "")?;
        }
        for rate in self.vehicle.max_rate_deg_s.into_iter().flatten() {
            Invalid::unless_positive("vehicle.max_rate_deg_s", rate, "leave it out where it is not known")?;
        }
        Ok(())
    }
}

fn check<P: Part>(key: &str, part: &Option<P>) -> Result<(), Invalid> {
    part.as_ref().map_or(Ok(()), |part| part.check().map_err(|invalid| invalid.within(key)))
}
