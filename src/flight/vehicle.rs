//! What a log says about the vehicle that flew it.

use serde::{Deserialize, Serialize};

/// What a log says about the vehicle that flew it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleRecord {
    /// Mass, kg.
    pub mass_kg: Option<f64>,
    /// Body rates that a full stick asks for: roll, pitch, yaw, rad/s.
    pub max_rate_rad_s: Option<[f64; 3]>,
    /// What moves it.
    #[serde(default)]
    pub kind: Option<VehicleKind>,
    /// How many rotors carry it.
    #[serde(default)]
    pub rotors: Option<u8>,
}

/// What a vehicle is. Models of this crate are of multirotors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VehicleKind {
    /// Carried by several fixed rotors.
    Multirotor,
    /// Carried by wings.
    FixedWing,
    /// Carried by rotors or by wings, at different times.
    Vtol,
    /// Carried by a rotor with a swashplate, or two.
    Helicopter,
    /// On wheels, or on water.
    Rover,
    /// Something else.
    Other,
}

impl VehicleKind {
    const ALL: [Self; 6] = [Self::Multirotor, Self::FixedWing, Self::Vtol, Self::Helicopter, Self::Rover, Self::Other];

    /// As files name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Multirotor => "multirotor",
            Self::FixedWing => "fixed_wing",
            Self::Vtol => "vtol",
            Self::Helicopter => "helicopter",
            Self::Rover => "rover",
            Self::Other => "other",
        }
    }

    /// The one of this name.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}
