//! The vehicle: the parameters of the compact model, as identified from its flights (paper section 4.1).

pub mod extension;
pub mod identified;
pub mod randomize;

use crate::base::check::{BadInput, Check, Invalid};
use crate::base::document::Library;
use crate::model::thrust::specific_thrust;
use extension::Extension;
pub use identified::{Identified, LogSpan};
use serde::{Deserialize, Serialize};

/// How far the thrust may fall as the command grows, as a share of full thrust.
const THRUST_DIP: f64 = 0.01;

/// What turns about the body axes x, y and z are called.
pub const AXES: [&str; 3] = ["roll", "pitch", "yaw"];

const LIBRARY: Library = Library {
    kind: "vehicle",
    folder: "configs/vehicles",
    builtin: &[
        ("seed_class", include_str!("../../configs/vehicles/seed_class.toml")),
        ("a2rl_class", include_str!("../../configs/vehicles/a2rl_class.toml")),
    ],
};

/// A quadrotor seen from its acro interface: body rates and collective thrust in, motion out. Body axes are x forward,
/// y left, z up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// What it is called.
    pub name: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Gravity where it flies, m/s2.
    pub gravity_m_s2: f64,
    /// Coefficients c0..c5 of Eq. 7, N: thrust = c0 + c1 u + c2 u^2 + c3 u^3 + c4 V + c5 u V, with the filtered thrust
    /// command u in [-1, 1] and the battery voltage V in volts.
    pub thrust_n: [f64; 6],
    /// Lags of its responses, s.
    pub time_constant_s: TimeConstants,
    /// Body rates at full command, deg/s.
    pub max_rate_deg_s: MaxRates,
    /// Drag.
    pub drag: Drag,
    /// Battery.
    pub battery: Battery,
    /// What the vehicle does beyond the compact model.
    #[serde(default, skip_serializing_if = "Extension::is_empty")]
    pub effects: Extension,
    /// Where the numbers come from, if from flights.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identified: Option<Identified>,
}

/// First-order response of each command (Eq. 6), s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeConstants {
    /// Of the roll rate, s.
    pub roll: f64,
    /// Of the pitch rate, s.
    pub pitch: f64,
    /// Of the yaw rate, s.
    pub yaw: f64,
    /// Of the thrust command, s.
    pub thrust: f64,
}

/// Body rates at full command, deg/s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaxRates {
    /// About x, deg/s.
    pub roll: f64,
    /// About y, deg/s.
    pub pitch: f64,
    /// About z, deg/s.
    pub yaw: f64,
}

/// Drag of an ellipsoid: half the density, times the coefficient, the area projected along the airflow and speed
/// squared.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// Along body x, y, z, m.
    pub semi_axes_m: [f64; 3],
    /// Without unit. Higher slows the top speed.
    pub coefficient: f64,
    /// Density of the air, kg/m3.
    pub air_density_kg_m3: f64,
}

/// Linear discharge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Battery {
    /// Voltage that a nominal flight starts with, V.
    pub full_v: f64,
    /// Voltage below which a flight ends, V.
    pub empty_v: f64,
    /// Change of voltage in flight, V/s; negative while it discharges.
    pub rate_v_s: f64,
}

impl Battery {
    /// Voltage at a charge between 0, empty, and 1, full.
    pub fn at(&self, charge: f64) -> f64 {
        self.empty_v + charge * (self.full_v - self.empty_v)
    }
}

impl Vehicle {
    /// Reads a vehicle by name or file.
    pub fn load(name: &str) -> Result<Self, BadInput> {
        LIBRARY.open(name)?.decode()
    }

    /// The same of another mass, kg: thrust and the area that drags are in proportion to it, so that it flies alike.
    #[must_use]
    pub fn with_mass(mut self, mass_kg: f64) -> Self {
        let ratio = mass_kg / self.mass_kg;
        self.thrust_n = self.thrust_n.map(|c| c * ratio);
        self.drag.semi_axes_m = self.drag.semi_axes_m.map(|axis| axis * ratio.sqrt());
        Self { mass_kg, ..self }
    }

    /// Time constants of roll, pitch, yaw and thrust, s.
    pub fn time_constants(&self) -> [f64; 4] {
        let TimeConstants { roll, pitch, yaw, thrust } = self.time_constant_s;
        [roll, pitch, yaw, thrust]
    }

    /// Body rates at full command about x, y, z, rad/s.
    pub fn max_rates_rad_s(&self) -> [f64; 3] {
        let MaxRates { roll, pitch, yaw } = self.max_rate_deg_s;
        [roll, pitch, yaw].map(f64::to_radians)
    }

    /// Thrust over weight at full command and full battery.
    pub fn thrust_to_weight(&self) -> f64 {
        self.thrust_at(1.0, self.battery.full_v) / (self.mass_kg * self.gravity_m_s2)
    }

    /// Thrust at the filtered command `u` and `v` volts, N.
    pub fn thrust_at(&self, u: f64, v: f64) -> f64 {
        specific_thrust(&self.thrust_n, u, v)
    }

    /// The thrust command that carries the vehicle at `v` volts; -1 or 1 where none does.
    pub fn hover_command(&self, v: f64) -> f64 {
        let (mut low, mut high) = (-1.0, 1.0);
        // Halving 50 times ends below double precision; thrust grows with the command.
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let lifts = self.thrust_at(middle, v) > self.mass_kg * self.gravity_m_s2;
            *(if lifts { &mut high } else { &mut low }) = middle;
        }
        low
    }

    /// Thrust must grow with the command, from nothing or more, and be able to lift the vehicle. Whatever keeps the
    /// `limits` of `model/thrust/shape.rs` passes.
    pub fn check_thrust(&self) -> Result<(), Invalid> {
        let finite = self.thrust_n.iter().all(|c| c.is_finite());
        let found = format!("{:?}", self.thrust_n);
        Invalid::unless(finite, "thrust_n", &found, "six finite numbers", "")?;
        for v in [self.battery.empty_v, self.battery.full_v] {
            // Command in hundredths, from none to full. A cubic may dip a little where the rotors idle.
            let dip = THRUST_DIP * self.thrust_at(1.0, v).abs();
            let idle = self.thrust_at(-1.0, v);
            let found = format!("{idle:.2} N at command -1 and {v:.1} V");
            let advice = "rotors do not pull down; check c0..c5";
            Invalid::unless(idle >= -dip, "thrust_n", found, "a thrust of zero or more", advice)?;
            let mut most = f64::NEG_INFINITY;
            for u in (-100..=100).map(|u| f64::from(u) / 100.0) {
                let thrust = self.thrust_at(u, v);
                if thrust < most - dip {
                    let found = format!("a thrust that falls at command {u} and {v:.1} V");
                    let advice = "check the order and signs of c0..c5";
                    return Err(Invalid::new("thrust_n", found, "a thrust that grows with the command", advice));
                }
                most = most.max(thrust);
            }
        }
        let ratio = self.thrust_to_weight();
        let found = format!("{ratio:.2} times the weight at full command and full battery");
        Invalid::unless(ratio > 1.0, "thrust_n", found, "more than the weight", "check the mass and c0..c5")
    }
}

impl Check for Vehicle {
    fn check(&self) -> Result<(), Invalid> {
        let TimeConstants { roll, pitch, yaw, thrust } = self.time_constant_s;
        for (key, value) in [
            ("mass_kg", self.mass_kg),
            ("gravity_m_s2", self.gravity_m_s2),
            ("time_constant_s.roll", roll),
            ("time_constant_s.pitch", pitch),
            ("time_constant_s.yaw", yaw),
            ("time_constant_s.thrust", thrust),
            ("max_rate_deg_s.roll", self.max_rate_deg_s.roll),
            ("max_rate_deg_s.pitch", self.max_rate_deg_s.pitch),
            ("max_rate_deg_s.yaw", self.max_rate_deg_s.yaw),
            ("drag.air_density_kg_m3", self.drag.air_density_kg_m3),
            ("battery.empty_v", self.battery.empty_v),
        ] {
            Invalid::unless_positive(key, value, "")?;
        }
        for (axis, value) in self.drag.semi_axes_m.into_iter().enumerate() {
            Invalid::unless_positive(&format!("drag.semi_axes_m[{axis}]"), value, "")?;
        }
        Invalid::unless_not_negative("drag.coefficient", self.drag.coefficient, "0 switches drag off")?;
        let Battery { full_v, empty_v, rate_v_s } = self.battery;
        let expected = format!("more than empty_v = {empty_v}");
        Invalid::unless(full_v.is_finite() && full_v > empty_v, "battery.full_v", full_v, &expected, "")?;
        let discharges = rate_v_s.is_finite() && rate_v_s <= 0.0;
        Invalid::unless(discharges, "battery.rate_v_s", rate_v_s, "zero or less", "discharge is negative")?;
        self.effects.check().map_err(|invalid| invalid.within("effects"))?;
        self.check_thrust()
    }
}
