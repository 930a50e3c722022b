//! The numbers that a diagnosis may move: those of the compact model, of every effect, and the voltage each flight
//! begins with.

use super::forms::{self, TAP_S, TAPS_S};
use crate::insight::criteria::believed::{
    SHORTEST_SHAPE, TRUST_DISCHARGE, TRUST_DRAG, TRUST_EFFECT, TRUST_RATE, TRUST_THRUST, TRUST_TIME_CONSTANT,
    TRUST_VOLTAGE,
};
use crate::insight::estimate::range::{DRAG_1_M, RATE_GAIN, TIME_CONSTANT_S};
use crate::model::dynamics::drag;
use crate::model::effects::{self, COUNT, Card, CompactNumber, LOG_COUNT, Quantities, Quantity};
use crate::model::vehicle::{AXES, Vehicle};
use std::ops::Range;

/// Order of the numbers: time constants (s), maximum rates (rad/s), c0..c5 (m/s2), drag per axis (1/m), discharge
/// (V/s), then all effects of the simulator, all others, what bends them, and the voltage at the beginning
/// of each flight (V).
pub const TAU: Range<usize> = 0..4;
pub const MAX_RATE: Range<usize> = 4..7;
pub const THRUST: Range<usize> = 7..13;
pub const DRAG: Range<usize> = 13..16;
pub const DISCHARGE: usize = 16;
pub const EFFECTS: usize = 17;
pub const LOG_AT: usize = EFFECTS + COUNT;
pub const FORMS: usize = LOG_AT + LOG_COUNT;
pub const BEGIN: usize = FORMS + forms::COUNT;

/// One number.
#[derive(Clone, Debug)]
pub struct ModelNumber {
    pub name: String,
    pub unit: &'static str,
    pub low: f64,
    pub high: f64,
    /// A physically small change.
    pub step: f64,
    /// How far the number may lie from the base vehicle's before that alone is evidence; infinite where the base does
    /// not say.
    pub trust: f64,
    /// What it enters.
    pub writes: Quantities,
    /// Whether it moves body rates, and whether forces or the voltage.
    pub rates: bool,
    pub forces: bool,
}

/// Where the parameters of an effect are among the numbers.
pub fn span(card: &Card) -> Range<usize> {
    let span = effects::span(card.id).unwrap_or(0..0);
    EFFECTS + span.start..EFFECTS + span.end
}

/// Whether a number is of the compact model's thrust or drag.
pub fn is_force(k: usize) -> bool {
    THRUST.contains(&k) || DRAG.contains(&k)
}

/// Where a number of the compact model is.
pub fn place(number: CompactNumber) -> Range<usize> {
    let time = |k: usize| TAU.start + k..TAU.start + k + 1;
    match number {
        CompactNumber::RollTime => time(0),
        CompactNumber::PitchTime => time(1),
        CompactNumber::YawTime => time(2),
        CompactNumber::ThrustTime => time(3),
        CompactNumber::Thrust => THRUST,
        CompactNumber::Drag => DRAG,
    }
}

/// Numbers and their values in the base vehicle, while they are listed.
#[derive(Default)]
pub struct Numbers {
    pub all: Vec<ModelNumber>,
    pub base: Vec<f64>,
}

/// Bounds, a small change, and how far it may lie from the base.
struct Extent {
    bounds: [f64; 2],
    step: f64,
    trust: f64,
}

impl Numbers {
    /// The numbers of `vehicle` for flights that begin at `begin_v` volts.
    pub fn new(vehicle: &Vehicle, begin_v: &[f64]) -> Self {
        let mut out = Self::default();
        out.response(vehicle);
        out.forces(vehicle);
        out.effects(vehicle);
        out.forms(vehicle);
        for (flight, volts) in begin_v.iter().enumerate() {
            let extent = Extent { bounds: [0.0, 1e3], step: 1e-2, trust: TRUST_VOLTAGE.get() };
            out.add(format!("begin_v.{flight}"), "V", *volts, extent, &[Quantity::Voltage]);
        }
        out
    }

    fn add(&mut self, name: String, unit: &'static str, value: f64, extent: Extent, writes: &[Quantity]) {
        let Extent { bounds: [low, high], step, trust } = extent;
        let writes = Quantities::of(writes);
        let reached = writes.reached(&[]);
        let rates = reached.any(&[Quantity::Gyro, Quantity::Integrated]);
        let forces = reached.any(&[Quantity::Accelerometer, Quantity::Voltage, Quantity::Integrated]);
        self.all.push(ModelNumber { name, unit, low, high, step, trust, writes, rates, forces });
        self.base.push(value);
    }

    /// How rates and thrust follow their commands.
    fn response(&mut self, vehicle: &Vehicle) {
        let tau = vehicle.time_constants();
        for (k, axis) in AXES.iter().chain(&["thrust"]).enumerate() {
            let extent = Extent { bounds: TIME_CONSTANT_S, step: 2e-4, trust: TRUST_TIME_CONSTANT.get() * tau[k] };
            let writes = if k < 3 { Quantity::RateCommand } else { Quantity::ThrustCommand };
            self.add(format!("time_constant_s.{axis}"), "s", tau[k], extent, &[writes]);
        }
        let rates = vehicle.max_rates_rad_s();
        for (k, axis) in AXES.iter().enumerate() {
            let bounds = RATE_GAIN.map(|gain| gain * rates[k]);
            let extent = Extent { bounds, step: 1e-3 * rates[k], trust: TRUST_RATE.get() * rates[k] };
            self.add(format!("max_rate_deg_s.{axis}"), "rad/s", rates[k], extent, &[Quantity::RateCommand]);
        }
    }

    /// Thrust, drag and the battery.
    fn forces(&mut self, vehicle: &Vehicle) {
        let full = vehicle.thrust_to_weight() * vehicle.gravity_m_s2;
        for k in 0..6 {
            let scale = if k < 4 { full } else { full / vehicle.battery.full_v };
            let extent = Extent { bounds: [-1e3, 1e3], step: 1e-3 * scale, trust: TRUST_THRUST.get() * scale };
            let c = vehicle.thrust_n[k] / vehicle.mass_kg;
            self.add(format!("thrust_n[{k}]"), "m/s2", c, extent, &[Quantity::SpecificForce]);
        }
        let drag = drag::ellipsoid(&vehicle.drag).map(|k| k / vehicle.mass_kg);
        for (k, axis) in ["x", "y", "z"].iter().enumerate() {
            let extent = Extent { bounds: DRAG_1_M, step: 2e-4, trust: TRUST_DRAG.get() };
            self.add(format!("drag_over_mass_1_m.{axis}"), "1/m", drag[k], extent, &[Quantity::SpecificForce]);
        }
        let extent = Extent { bounds: [-1.0, 1.0], step: 1e-5, trust: TRUST_DISCHARGE.get() };
        self.add("battery.rate_v_s".into(), "V/s", vehicle.battery.rate_v_s, extent, &[Quantity::Voltage]);
    }

    /// What bends response, thrust, a velocity's lag and the drag: nothing, in the base.
    fn forms(&mut self, vehicle: &Vehicle) {
        for i in 0..forms::RESPONSE {
            let name = format!("response.{}.{}", AXES[i / TAPS_S.len()], i % TAPS_S.len());
            let extent = Extent { bounds: [-0.1, 0.1], step: 0.1 * TAP_S, trust: 10.0 * TAP_S };
            self.add(name, "s", 0.0, extent, &[Quantity::Gyro]);
        }
        let full = vehicle.thrust_to_weight() * vehicle.gravity_m_s2;
        for i in 0..forms::THRUST {
            let extent = Extent { bounds: [-full, full], step: 1e-3 * full, trust: full };
            self.add(format!("thrust.{i}"), "m/s2", 0.0, extent, &[Quantity::SpecificForce]);
        }
        let extent = Extent { bounds: [0.0, 1.0], step: 0.05, trust: 1.0 };
        self.add("velocity.delay".into(), "1", 0.0, extent, &[Quantity::Integrated]);
    }

    /// All effects, those of the simulator at the vehicle's own sizes.
    fn effects(&mut self, vehicle: &Vehicle) {
        let own = vehicle.effects.drawn(&[0.0; COUNT]);
        let values = own.into_iter().chain([0.0; LOG_COUNT]);
        let parameters = effects::cards().flat_map(|card| card.parameters.iter().enumerate().map(move |p| (card, p)));
        for ((card, (i, p)), value) in parameters.zip(values) {
            // A time constant that goes to nothing is another effect.
            let low = if card.shape == Some(i) { SHORTEST_SHAPE.get() * p.typical[0] } else { p.low };
            let [least, most] = p.typical;
            let extent = Extent { bounds: [low, p.high], step: 0.05 * least, trust: TRUST_EFFECT.get() * most };
            self.add(format!("{}.{}", card.id, p.name), p.unit, value, extent, card.writes);
        }
    }
}
