//! The streams of a mapping.

use super::frames::{Body, VelocityFrame, World};
use super::quantity::{Flag, Scalar, Time, Vector};
use super::units::{Acceleration, AngularRate, Current, Length, One, Speed, Voltage};
use crate::base::check::Invalid;
use crate::flight::MOTORS;
use serde::Deserialize;

/// Commands to the rate controller.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetpointPart {
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
    pub otherwise: Option<Box<SetpointPart>>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImuPart {
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
    pub otherwise: Option<Box<ImuPart>>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OdometryPart {
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
    pub otherwise: Option<Box<OdometryPart>>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BatteryPart {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    pub voltage: Option<Scalar<Voltage>>,
    pub current: Option<Scalar<Current>>,
    pub otherwise: Option<Box<BatteryPart>>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotorsPart {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    /// One column a rotor, up to 8.
    pub speed: Option<Vector<AngularRate>>,
    pub otherwise: Option<Box<RotorsPart>>,
}

/// What the motors were sent.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotorsPart {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    /// One column a motor, up to 8; 0..1.
    pub command: Option<Vector<One>>,
    pub otherwise: Option<Box<MotorsPart>>,
}

/// What the flight controller says of the flight. Each flag is read from the first alternative that a file has.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StatesPart {
    #[serde(default)]
    pub source: String,
    pub time: Option<Time>,
    #[serde(default)]
    pub optional: bool,
    pub armed: Option<Flag>,
    pub in_air: Option<Flag>,
    pub otherwise: Option<Box<StatesPart>>,
}

/// Where the rows of a stream come from.
#[derive(Clone, Copy, Debug)]
pub struct PartOrigin<'a> {
    /// Topic or table; "" is the one table of a CSV file, "_gps" that of a second file beside it, `NAME_gps.csv`.
    pub source: &'a str,
    pub time: Option<&'a Time>,
    /// A file without the source is fine, the stream then empty.
    pub optional: bool,
}

/// What the streams of a mapping have in common.
pub trait Part {
    fn origin(&self) -> PartOrigin<'_>;
    fn otherwise(&self) -> Option<&Self>;
    /// (Source, field) of all quantities.
    fn columns(&self) -> Vec<(&str, &str)>;
    /// The quantities alone.
    fn check(&self) -> Result<(), Invalid>;
}

macro_rules! part {
    ($part:ty: $($quantity:ident[$count:expr]),+ $(; $check:expr)?) => {
        impl Part for $part {
            fn origin(&self) -> PartOrigin<'_> {
                PartOrigin { source: &self.source, time: self.time.as_ref(), optional: self.optional }
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

part!(SetpointPart: rate[3..=3], thrust[1..=1]);
part!(ImuPart: gyro[3..=3], specific_force[3..=3]; |imu| {
    let ok = imu.rotation_deg.iter().all(|angle| angle.is_finite());
    Invalid::unless(ok, "rotation_deg", format!("{:?}", imu.rotation_deg), "three finite angles", "")
});
part!(OdometryPart: position[3..=3], attitude[4..=4], velocity[3..=3]);
part!(BatteryPart: voltage[1..=1], current[1..=1]);
part!(RotorsPart: speed[1..=MOTORS]);
part!(MotorsPart: command[1..=MOTORS]);
part!(StatesPart: armed[1..=1], in_air[1..=1]);
