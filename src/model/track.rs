//! The track: a start pad and gates in order, in a bounded volume (paper section 3).
//!
//! The world frame is ENU: x east, y north, z up, metres. Headings are counter-clockwise from x, degrees.

mod check;
mod gate;
mod shape;
pub mod spline;

pub use gate::{Gate, GateKind};
pub use shape::Shape;

use crate::base::check::BadInput;
use crate::base::document::Library;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

const LIBRARY: Library = Library {
    kind: "track",
    folder: "tracks",
    builtin: &[
        ("a2rl_s2", include_str!("../../tracks/a2rl_s2.toml")),
        ("a2rl_s1", include_str!("../../tracks/a2rl_s1.toml")),
        ("uzh_split_s", include_str!("../../tracks/uzh_split_s.toml")),
        ("figure_eight", include_str!("../../tracks/figure_eight.toml")),
        ("square", include_str!("../../tracks/square.toml")),
    ],
};

/// A cyclic track. A lap is all gates in order and the first one again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Track {
    /// What it is called.
    pub name: String,
    /// Where a race begins.
    pub start: Pose,
    /// Leaving it ends a flight.
    pub volume: Volume,
    /// In the order in which they are flown.
    pub gates: Vec<Gate>,
    /// Parts of the track to report on.
    #[serde(default)]
    pub sections: Vec<Section>,
}

/// A place to stand, level, and a direction to look in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pose {
    /// World, m.
    pub position_m: [f64; 3],
    /// Counter-clockwise from x, deg.
    pub heading_deg: f64,
}

/// The box that may be flown in; its z are the altitude limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Volume {
    /// Lower corner, m.
    pub min_m: [f64; 3],
    /// Upper corner, m.
    pub max_m: [f64; 3],
}

/// A named part of the track. It is passed when its last gate is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// What it is called.
    pub name: String,
    /// Places in the list of gates, counted from 0, virtual ones included.
    pub gates: Vec<usize>,
}

impl Track {
    /// Reads a track by name or file. Fails on anything that cannot be raced on.
    pub fn load(name: &str) -> Result<Self, BadInput> {
        LIBRARY.open(name)?.decode()
    }

    /// What gate `i` is called: physical gates are counted from 0, virtual ones from V1.
    pub fn gate_label(&self, i: usize) -> String {
        let kind = self.gates[i].kind;
        let before = self.gates[..i].iter().filter(|gate| gate.kind == kind).count();
        match kind {
            GateKind::Physical => before.to_string(),
            GateKind::Virtual => format!("V{}", before + 1),
        }
    }

    /// Centres of the gates, in order, m.
    pub fn centres(&self) -> Vec<Vector3<f64>> {
        self.gates.iter().map(Gate::position).collect()
    }
}

impl Pose {
    /// World, m.
    pub fn position(&self) -> Vector3<f64> {
        self.position_m.into()
    }

    /// Counter-clockwise from x, rad.
    pub fn heading_rad(&self) -> f64 {
        self.heading_deg.to_radians()
    }
}

impl Volume {
    /// Whether a place, m, is in it.
    pub fn contains(&self, position: &Vector3<f64>) -> bool {
        (0..3).all(|axis| self.min_m[axis] <= position[axis] && position[axis] <= self.max_m[axis])
    }
}
