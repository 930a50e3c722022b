//! The numbers that a diagnosis may move: those of the compact model, of every effect, and the voltage each flight begins with.

use super::predict::Dirty;
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::extended::Extended;
use crate::model::dynamics::{Factors, Parameters, drag};
use crate::model::effects::{self, COUNT, Card, EffectKind, LOG, LOG_COUNT, MODEL, ResidualChannel};
use crate::model::vehicle::{MaxRates, TimeConstants, Vehicle};
use std::ops::Range;

/// Order of the numbers: time constants (s), maximum rates (rad/s), c0..c5 (m/s2), drag per axis (1/m), discharge (V/s), then all effects of the
/// simulator, all others, and the voltage at the beginning of each flight (V).
pub const TAU: Range<usize> = 0..4;
pub const MAX_RATE: Range<usize> = 4..7;
pub const THRUST: Range<usize> = 7..13;
pub const DRAG: Range<usize> = 13..16;
pub const DISCHARGE: usize = 16;
const EFFECTS: usize = 17;
const LOG_AT: usize = EFFECTS + COUNT;
pub const BEGIN: usize = LOG_AT + LOG_COUNT;

/// Where a number enters the prediction; everything after it has to be computed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    Response,
    Spin,
    Battery,
    Force,
    Sensor,
}

/// One number.
#[derive(Clone, Debug)]
pub struct ModelNumber {
    pub name: String,
    pub unit: &'static str,
    pub low: f64,
    pub high: f64,
    /// A physically small change.
    pub step: f64,
    /// How far the number may lie from the base vehicle's before that alone is evidence; infinite where the base does not say.
    pub trust: f64,
    pub stage: Stage,
    /// Whether it moves body rates, and whether forces or the voltage.
    pub rates: bool,
    pub forces: bool,
}

/// All numbers, and the vehicle they are about.
#[derive(Clone, Debug)]
pub struct Model {
    pub numbers: Vec<ModelNumber>,
    /// Those of the base vehicle, without effects but its own.
    pub base: Vec<f64>,
    vehicle: Vehicle,
}

/// Where the parameters of an effect are among the numbers.
pub fn span(card: &Card) -> Range<usize> {
    let span = effects::span(card.id).unwrap_or(0..0);
    EFFECTS + span.start..EFFECTS + span.end
}

/// Every effect, those of the simulator first.
pub fn cards() -> impl Iterator<Item = &'static Card> {
    MODEL.into_iter().chain(LOG)
}

impl Model {
    /// The numbers of `vehicle` for flights that begin at `begin_v` volts.
    pub fn new(vehicle: &Vehicle, begin_v: &[f64]) -> Self {
        let mut numbers = Vec::new();
        let mut base = Vec::new();
        let mut add =
            |name: &str, unit, value: f64, [low, high]: [f64; 2], step: f64, trust: f64, stage, moves: [bool; 2]| {
                let [rates, forces] = moves;
                numbers.push(ModelNumber { name: name.into(), unit, low, high, step, trust, stage, rates, forces });
                base.push(value);
            };
        let tau = vehicle.time_constants();
        for (k, axis) in ["roll", "pitch", "yaw", "thrust"].iter().enumerate() {
            let name = format!("time_constant_s.{axis}");
            add(&name, "s", tau[k], [5e-4, 0.3], 2e-4, tau[k], Stage::Response, [k < 3, k == 3]);
        }
        let rates = vehicle.max_rates_rad_s();
        for (k, axis) in ["roll", "pitch", "yaw"].iter().enumerate() {
            let name = format!("max_rate_deg_s.{axis}");
            add(
                &name,
                "rad/s",
                rates[k],
                [0.2 * rates[k], 5.0 * rates[k]],
                1e-3 * rates[k],
                0.5 * rates[k],
                Stage::Response,
                [true, false],
            );
        }
        let full = vehicle.thrust_to_weight() * vehicle.gravity_m_s2;
        let volts = vehicle.battery.full_v;
        for k in 0..6 {
            let scale = if k < 4 { full } else { full / volts };
            let c = vehicle.thrust_n[k] / vehicle.mass_kg;
            add(&format!("thrust_n[{k}]"), "m/s2", c, [-1e3, 1e3], 1e-3 * scale, scale, Stage::Force, [false, true]);
        }
        let drag = drag::ellipsoid(&vehicle.drag).map(|k| k / vehicle.mass_kg);
        for (k, axis) in ["x", "y", "z"].iter().enumerate() {
            add(
                &format!("drag_over_mass_1_m.{axis}"),
                "1/m",
                drag[k],
                [0.0, 0.5],
                2e-4,
                0.05,
                Stage::Force,
                [false, true],
            );
        }
        add("battery.rate_v_s", "V/s", vehicle.battery.rate_v_s, [-1.0, 1.0], 1e-5, 0.1, Stage::Battery, [false, true]);
        let own = vehicle.effects.drawn(&[0.0; COUNT]);
        for card in cards() {
            let stage = stage(card);
            let both = card.kind == EffectKind::Sensor || card.kind == EffectKind::Random;
            let rates = card.channels.contains(&ResidualChannel::Rate);
            let moves = [both || rates, both || !rates || card.channels.len() > 1];
            for p in card.parameters {
                // A time constant that goes to nothing is another effect.
                let shape = p.name == "tau" && card.parameters.len() > 1;
                let low = if shape { 0.3 * p.typical[0] } else { p.low };
                let value = if base_index(card) { own[span_of(card, p.name)] } else { 0.0 };
                add(
                    &format!("{}.{}", card.id, p.name),
                    p.unit,
                    value,
                    [low, p.high],
                    0.05 * p.typical[0],
                    3.0 * p.typical[1],
                    stage,
                    moves,
                );
            }
        }
        for (flight, volts) in begin_v.iter().enumerate() {
            add(&format!("begin_v.{flight}"), "V", *volts, [0.0, 1e3], 1e-2, 10.0, Stage::Battery, [false, true]);
        }
        Self { numbers, base, vehicle: vehicle.clone() }
    }

    /// Where the thrust command is a measured rotor speed, the voltage has no part in the thrust.
    pub fn forget_voltage(&mut self) {
        let middle = 0.5 * (self.vehicle.battery.full_v + self.vehicle.battery.empty_v);
        for (with, without) in [(4, 0), (5, 1)] {
            self.base[THRUST.start + without] += middle * self.base[THRUST.start + with];
            self.base[THRUST.start + with] = 0.0;
            (self.numbers[THRUST.start + with].low, self.numbers[THRUST.start + with].high) = (0.0, 0.0);
        }
    }

    /// The parameters of the extended model at `x`, for steps of any length.
    pub fn parameters(&self, x: &[f64]) -> Extended<f64> {
        let mut p = Parameters::new(&self.vehicle, &Factors::NOMINAL, CONTROL_S);
        let tau = std::array::from_fn(|k| x[TAU.start + k]);
        p.max_rate = std::array::from_fn(|k| x[MAX_RATE.start + k]);
        p.thrust = std::array::from_fn(|k| x[THRUST.start + k]);
        p.drag = std::array::from_fn(|k| x[DRAG.start + k]);
        p.voltage_rate = x[DISCHARGE];
        Extended::of(&self.vehicle, p, tau, std::array::from_fn(|k| x[EFFECTS + k]))
    }

    /// The parameters of sensors and chance at `x`.
    pub fn sensors<'a>(&self, x: &'a [f64]) -> &'a [f64] {
        &x[LOG_AT..BEGIN]
    }

    /// EffectParameter `name` of effect `id` at `x`; 0 for one that does not exist.
    pub fn of(&self, x: &[f64], id: &str, name: &str) -> f64 {
        let Some(card) = effects::card(id) else { return 0.0 };
        card.parameters.iter().position(|p| p.name == name).map_or(0.0, |i| x[span(card).start + i])
    }

    /// What of a prediction at `x` has to be made again where the numbers `which` are changed.
    pub fn dirty(&self, which: &[usize], x: &[f64]) -> Dirty {
        let numbers = || which.iter().map(|&k| &self.numbers[k]);
        // These carry rates into forces, and thrust into rates.
        let present =
            |ids: &[&str]| ids.iter().filter_map(|id| effects::card(id)).any(|card| span(card).any(|k| x[k] != 0.0));
        let mixed = present(&["mixer_thrust_loss", "rate_thrust_coupling", "imu_lever_arm"]);
        let mixed_back = present(&["weak_motor", "yaw_authority_loss"]);
        Dirty {
            stage: numbers().map(|n| n.stage).min().unwrap_or(Stage::Sensor),
            rates: numbers().any(|n| n.rates) || mixed_back,
            forces: numbers().any(|n| n.forces) || mixed,
            corrections: which.iter().any(|&k| (LOG_AT..BEGIN).contains(&k)),
        }
    }

    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// The base vehicle with the compact model's numbers of `x`, and no change of its effects.
    pub fn vehicle_at(&self, x: &[f64]) -> Vehicle {
        let mut v = self.vehicle.clone();
        let [roll, pitch, yaw, thrust] = std::array::from_fn(|k| x[TAU.start + k]);
        v.time_constant_s = TimeConstants { roll, pitch, yaw, thrust };
        let [roll, pitch, yaw] = std::array::from_fn(|k| x[MAX_RATE.start + k].to_degrees());
        v.max_rate_deg_s = MaxRates { roll, pitch, yaw };
        v.thrust_n = std::array::from_fn(|k| x[THRUST.start + k] * v.mass_kg);
        let k: [f64; 3] = std::array::from_fn(|k| (x[DRAG.start + k]).max(1e-5) * v.mass_kg);
        v.drag.semi_axes_m = drag::semi_axes(k, v.drag.coefficient, v.drag.air_density_kg_m3);
        v.battery.rate_v_s = x[DISCHARGE].min(0.0);
        v
    }
}

fn base_index(card: &Card) -> bool {
    MODEL.iter().any(|c| c.id == card.id)
}

fn span_of(card: &Card, name: &str) -> usize {
    span(card).start - EFFECTS + card.parameters.iter().position(|p| p.name == name).unwrap_or(0)
}

/// Where the effect enters.
fn stage(card: &Card) -> Stage {
    match card.kind {
        EffectKind::Timing => Stage::Response,
        EffectKind::Battery => Stage::Battery,
        EffectKind::Thrust | EffectKind::Drag => Stage::Force,
        EffectKind::Random | EffectKind::Sensor => match card.id {
            "stream_offset" | "clock_skew" | "command_dropout" => Stage::Response,
            "velocity_lag" => Stage::Force,
            _ => Stage::Sensor,
        },
    }
}
