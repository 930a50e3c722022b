//! What the columns of a file mean: which is which quantity, in which unit, with which sign, in which frame.

mod apply;
mod frames;
mod join;
mod quantity;
mod units;

pub use frames::{Body, VelocityFrame, World};
pub use quantity::{Scalar, Time, Vector};
pub use units::{Acceleration, AngularRate, Current, Length, Speed, Voltage};

use crate::check::{BadInput, Check, Invalid};
use crate::document::Library;
use serde::Deserialize;
use std::collections::BTreeSet;
use units::One;

pub(super) const LIBRARY: Library = Library {
    kind: "mapping",
    folder: "configs/mappings",
    builtin: &[
        ("canonical", include_str!("../../configs/mappings/canonical.toml")),
        ("betaflight", include_str!("../../configs/mappings/betaflight.toml")),
        ("betaflight_csv", include_str!("../../configs/mappings/betaflight_csv.toml")),
        ("px4", include_str!("../../configs/mappings/px4.toml")),
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
    pub setpoint: Option<Setpoint>,
    pub imu: Option<Imu>,
    pub odometry: Option<Odometry>,
    pub battery: Option<Battery>,
    pub rotors: Option<Rotors>,
    /// For files that do not say; what the file says wins.
    #[serde(default)]
    pub vehicle: VehicleFigures,
}

/// Where the rows of a stream come from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin<'a> {
    /// Topic or table; "" is the one table of a CSV file, "_gps" that of a second file beside it, `NAME_gps.csv`.
    pub source: &'a str,
    pub time: Option<&'a Time>,
    /// A file without the source is fine, the stream then empty.
    pub optional: bool,
}

/// Commands to the rate controller.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setpoint {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    pub body: Option<Body>,
    pub rate: Option<Vector<AngularRate>>,
    /// Collective thrust, 0..1.
    pub thrust: Option<Scalar<One>>,
    /// To be tried where the file lacks the source or the columns above.
    pub otherwise: Option<Box<Setpoint>>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Imu {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    pub body: Option<Body>,
    pub gyro: Option<Vector<AngularRate>>,
    pub specific_force: Option<Vector<Acceleration>>,
    /// How the sensor is mounted: the roll, pitch and yaw (about z, then y, then x, front-left-up) that turn the body's
    /// axes into the sensor's.
    #[serde(default)]
    pub rotation_deg: [f64; 3],
    pub otherwise: Option<Box<Imu>>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Odometry {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    pub body: Option<Body>,
    pub world: Option<World>,
    /// x, y, z of the world frame.
    pub position: Option<Vector<Length>>,
    /// w, x, y, z, in whatever order the file has them; body to world.
    pub attitude: Option<Vector<One>>,
    pub velocity: Option<Vector<Speed>>,
    #[serde(default)]
    pub velocity_frame: VelocityFrame,
    pub otherwise: Option<Box<Odometry>>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Battery {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    pub voltage: Option<Scalar<Voltage>>,
    pub current: Option<Scalar<Current>>,
    pub otherwise: Option<Box<Battery>>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotors {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    pub speed: Option<Vector<AngularRate>>,
    pub otherwise: Option<Box<Rotors>>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleFigures {
    pub mass_kg: Option<f64>,
    /// Body rates that a full stick asks for: roll, pitch, yaw.
    pub max_rate_deg_s: Option<[f64; 3]>,
}

/// What the streams of a mapping have in common.
pub(super) trait Part {
    fn origin(&self) -> Origin<'_>;
    fn otherwise(&self) -> Option<&Self>;
    /// (Source if it is another than the stream's, column) of all quantities.
    fn columns(&self) -> Vec<(&str, &str)>;
    /// The quantities alone.
    fn check(&self) -> Result<(), Invalid>;
}

macro_rules! part {
    ($part:ty: $($quantity:ident[$count:literal]),+ $(; $check:expr)?) => {
        impl Part for $part {
            fn origin(&self) -> Origin<'_> {
                Origin { source: &self.source, time: self.time.as_ref(), optional: self.optional }
            }

            fn otherwise(&self) -> Option<&Self> {
                self.otherwise.as_deref()
            }

            fn columns(&self) -> Vec<(&str, &str)> {
                let mut columns: Vec<_> = self.time.iter().map(|time| (&*self.source, &*time.field)).collect();
                $(columns.extend(self.$quantity.iter().flat_map(|quantity| quantity.columns(&self.source)));)+
                columns
            }

            fn check(&self) -> Result<(), Invalid> {
                let some = $(self.$quantity.is_some())||+;
                let names = [$(stringify!($quantity)),+].join(", ");
                Invalid::unless(some, "", "a stream without quantities", &format!("one of {names}"), "")?;
                $(if let Some(quantity) = &self.$quantity {
                    quantity.check($count).map_err(|invalid| invalid.within(stringify!($quantity)))?;
                })+
                $({
                    let check: fn(&Self) -> Result<(), Invalid> = $check;
                    check(self)?;
                })?
                match &self.otherwise {
                    Some(otherwise) => Part::check(&**otherwise).map_err(|invalid| invalid.within("otherwise")),
                    None => Ok(()),
                }
            }
        }
    };
}

part!(Setpoint: rate[3], thrust[1]);
part!(Imu: gyro[3], specific_force[3]; |imu| {
    let ok = imu.rotation_deg.iter().all(|angle| angle.is_finite());
    Invalid::unless(ok, "rotation_deg", format!("{:?}", imu.rotation_deg), "three finite angles", "")
});
part!(Odometry: position[3], attitude[4], velocity[3]);
part!(Battery: voltage[1], current[1]);
part!(Rotors: speed[4]);

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
        let mut columns = BTreeSet::new();
        let time = self.time.as_ref();
        chain(&self.setpoint, time, &mut columns);
        chain(&self.imu, time, &mut columns);
        chain(&self.odometry, time, &mut columns);
        chain(&self.battery, time, &mut columns);
        chain(&self.rotors, time, &mut columns);
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
            || self.rotors.is_some();
        Invalid::unless(some, "", "no stream", "one of [setpoint], [imu], [odometry], [battery], [rotors]", "")?;
        check("setpoint", &self.setpoint)?;
        check("imu", &self.imu)?;
        check("odometry", &self.odometry)?;
        check("battery", &self.battery)?;
        check("rotors", &self.rotors)?;
        if let Some(mass) = self.vehicle.mass_kg {
            Invalid::unless_positive("vehicle.mass_kg", mass, "leave it out where it is not known")?;
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
