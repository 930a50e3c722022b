//! What an identification found: the vehicle, and everything to judge it by.

use super::estimate::Estimated;
use super::fits::Kept;
use super::rates::Compared;
use super::{IdentifyOptions, fastest, full_stick};
use crate::base::stats::Score;
use crate::flight::spans::Span;
use crate::insight::prepare::data::Data;
use crate::model::effects::ControllerPart;
use crate::model::vehicle::identified::{Origin, ThrustSource};
use crate::model::vehicle::{AXES, Identified, LogSpan, Vehicle};
use serde::Serialize;
use std::collections::BTreeMap;

/// A first-order response: a row of the paper's Table 1. Scores are those of the validation part.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Response {
    /// Time constant, s.
    pub tau_s: Estimated,
    /// Constant that the measurement has too much, in `unit`.
    pub offset: Estimated,
    /// Root mean square error, in `unit`.
    pub rmse: Option<f64>,
    /// Mean absolute error, in `unit`.
    pub mae: Option<f64>,
    /// Share of the variance that is explained.
    pub r2: Option<f64>,
    /// Samples that were fitted.
    pub n_train: usize,
    /// Samples that it is scored on.
    pub n_validation: usize,
    /// Of offset, RMSE and MAE.
    pub unit: &'static str,
}

/// Drag.
#[derive(Clone, Debug, Default, Serialize)]
pub struct DragEstimate {
    /// Deceleration over speed squared along x, y, z, 1/m.
    pub k_1_m: [Estimated; 3],
    /// The ellipsoid with these, given its coefficient.
    pub semi_axes_m: Option<[f64; 3]>,
    /// The base vehicle's drag coefficient, without unit.
    pub coefficient: Option<f64>,
    /// 99 % of the speed in flight, m/s.
    pub flown_m_s: Option<f64>,
}

/// The thrust in numbers that people know, and what it was identified from.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ThrustEstimate {
    /// What it was identified from.
    pub source: ThrustSource,
    /// Lag of the rotors behind the motors' outputs, where these were logged, s.
    pub rotor_lag_s: Estimated,
    /// Lag of the motors' outputs behind the collective command, s, and the share of their mean that it explains.
    pub command_lag_s: Option<f64>,
    /// R2 of the mean motor output as the collective command tells it.
    pub command_r2: Option<f64>,
    /// c0..c5 of Eq. 7 over the motors' outputs (0 to 1 taken as -1 to 1), where these were logged, N.
    pub over_motors_n: Option<[f64; 6]>,
    /// Throttle that carries the vehicle in the middle of its pack, 0..1.
    pub hover_throttle: Option<f64>,
    /// Thrust of full throttle and full pack, N.
    pub full_n: Estimated,
    /// 1 and 99 % of the throttle in flight, 0..1.
    pub flown_throttle: Option<[f64; 2]>,
}

/// Discharge.
#[derive(Clone, Debug, Default, Serialize)]
pub struct BatteryEstimate {
    /// Voltage at the start, V.
    pub initial_v: Estimated,
    /// Change of the voltage, V/s.
    pub rate_v_s: Estimated,
    /// Of the line, on the validation part, V.
    pub score: Option<Score>,
}

/// A signal, measured and predicted, over training and validation part.
#[derive(Clone, Debug)]
pub struct ComparedChannel {
    /// What was measured.
    pub name: String,
    /// Of its numbers.
    pub unit: &'static str,
    /// On the part that was fitted.
    pub train: Compared,
    /// On the rest.
    pub validation: Compared,
}

impl ComparedChannel {
    /// How well the validation part was predicted.
    pub fn score(&self) -> Score {
        Score::of(&self.validation.measured, &self.validation.predicted)
    }
}

/// Everything that was found.
#[derive(Clone, Debug)]
pub struct Identification {
    /// What `train` reads: fitted on all of the flights.
    pub vehicle: Vehicle,
    /// The vehicle that the figures are of: everything that could be fitted on the training part alone. `racer predict`
    /// makes the same figures of it.
    pub validated: Vehicle,
    /// Which numbers of the vehicle the logs told.
    pub kept: Kept,
    /// Roll, pitch, yaw, thrust.
    pub response: [Response; 4],
    /// Body rates at full command, rad/s.
    pub max_rate_rad_s: [Estimated; 3],
    /// c0..c5 of Eq. 7 for the command in [-1, 1], N.
    pub thrust_n: [Estimated; 6],
    /// The same in numbers that people know.
    pub thrust: ThrustEstimate,
    /// Drag.
    pub drag: DragEstimate,
    /// What the flight controller makes of commands beyond a lag, as far as the logs tell it.
    pub controller: BTreeMap<ControllerPart, Estimated>,
    /// Discharge.
    pub battery: BatteryEstimate,
    /// Constant error of the accelerometer along x, y, z, m/s2.
    pub accelerometer_bias_m_s2: [Estimated; 3],
    /// Body rates that a full command asks for, rad/s.
    pub full_rate_rad_s: [f64; 3],
    /// 1 and 99 % of the thrust command in flight, -1..1.
    pub flown: Option<[f64; 2]>,
    /// 99 % of the speed in flight, m/s.
    pub fastest_m_s: Option<f64>,
    /// Usable flight of all logs, s.
    pub usable_s: f64,
    /// What a reader should know besides.
    pub remarks: Vec<String>,
    /// Signals, measured and predicted; none where nothing could be told.
    pub channels: Vec<ComparedChannel>,
}

impl Identification {
    /// The base vehicle, with what the logs and options say without any fit.
    pub(super) fn new(data: &Data, options: &IdentifyOptions) -> Self {
        let mut vehicle = options.base.clone();
        vehicle.name = data.flights.first().map_or("identified".into(), |f| f.quality.log.stem());
        let spans = data.flights.iter().map(|flight| {
            let usable = &flight.quality.usable;
            let span: Option<Span> = usable.first().zip(usable.last()).map(|(first, last)| [first[0], last[1]]);
            LogSpan { name: flight.quality.log.name.clone(), span_s: span.unwrap_or_default() }
        });
        let said = data.flights.iter().find_map(|flight| flight.quality.log.vehicle.max_rate_rad_s);
        let said = options.max_rate_rad_s.or(said);
        let full_rate_rad_s = said.unwrap_or_else(|| full_stick::at_least(data, options.base.max_rates_rad_s()));
        vehicle.identified = Some(Identified {
            racer: env!("CARGO_PKG_VERSION").into(),
            base: options.base.name.clone(),
            logs: spans.collect(),
            full_rate_deg_s: full_rate_rad_s.map(f64::to_degrees),
            thrust_from: ThrustSource::Command,
            origin: Default::default(),
            assumed: Default::default(),
            interval: Default::default(),
            rotors: None,
            sensors: None,
        });
        let mut out = Self {
            validated: vehicle.clone(),
            vehicle,
            kept: Kept::default(),
            response: Default::default(),
            max_rate_rad_s: Default::default(),
            thrust_n: Default::default(),
            thrust: Default::default(),
            drag: Default::default(),
            controller: Default::default(),
            battery: Default::default(),
            accelerometer_bias_m_s2: Default::default(),
            full_rate_rad_s,
            flown: None,
            fastest_m_s: fastest(data),
            usable_s: data.usable_s(),
            remarks: Vec::new(),
            channels: Vec::new(),
        };
        out.origin("full_rate_deg_s", if options.max_rate_rad_s.is_some() { Origin::Option } else { Origin::Record });
        if said.is_none() {
            let why = "what a full stick asks for: neither the logs nor --full-rates say it";
            out.assume("full_rate_deg_s", why);
        }
        let said = data.flights.iter().find_map(|flight| flight.quality.log.vehicle.mass_kg);
        out.origin("mass_kg", if options.mass_kg.is_some() { Origin::Option } else { Origin::Record });
        match options.mass_kg.or(said) {
            // What the base vehicle lends is told in accelerations.
            Some(mass) => out.vehicle = out.vehicle.with_mass(mass),
            None => out.assume("mass_kg", "a flight does not tell it: weigh the vehicle and give --mass"),
        }
        ["gravity_m_s2", "drag.air_density_kg_m3"].into_iter().for_each(|key| out.origin(key, Origin::Base));
        out
    }

    /// Whether the base vehicle lent this number, and why.
    pub fn lent(&self, key: &str) -> Option<&String> {
        self.vehicle.identified.as_ref().and_then(|identified| identified.assumed.get(key))
    }

    /// Every parameter but the responses, as people read it: name, estimate, digits, unit.
    pub fn parameters(&self) -> Vec<(String, Estimated, usize, &'static str)> {
        let mut rows = Vec::new();
        for (axis, rate) in AXES.iter().zip(&self.max_rate_rad_s) {
            rows.push((format!("maximum {axis} rate"), rate.times(1f64.to_degrees()), 1, "deg/s"));
        }
        let small = self.thrust.full_n.value.is_some_and(|newtons| newtons < 10.0);
        rows.push(("thrust at full throttle".into(), self.thrust.full_n.clone(), if small { 3 } else { 1 }, "N"));
        if self.thrust.rotor_lag_s.value.is_some() {
            rows.push(("lag of the rotors".into(), self.thrust.rotor_lag_s.times(1e3), 1, "ms"));
        }
        let of_all = self.controller.get(&ControllerPart::Inertia).and_then(|size| size.value).unwrap_or(0.0);
        for (part, size) in &self.controller {
            rows.push(match part {
                ControllerPart::Delay => ("delay of the rates".into(), size.times(1e3), 1, "ms"),
                ControllerPart::YawDelay => ("delay of yaw beyond that".into(), size.times(1e3), 1, "ms"),
                ControllerPart::Inertia => ("natural frequency of the rates".into(), size.inverse().root(), 1, "rad/s"),
                ControllerPart::YawInertia => {
                    ("natural frequency of yaw".into(), size.less(-of_all).inverse().root(), 1, "rad/s")
                }
                ControllerPart::Slew => ("angular acceleration, at most".into(), size.inverse(), 0, "rad/s2"),
                ControllerPart::Room => ("throttle kept free for turns".into(), size.clone(), 3, "s/rad"),
            });
        }
        for (axis, k) in ["x", "y", "z"].iter().zip(&self.drag.k_1_m) {
            rows.push((format!("drag over mass, {axis}"), k.clone(), 4, "1/m"));
        }
        rows.push(("initial voltage".into(), self.battery.initial_v.clone(), 3, "V"));
        rows.push(("discharge".into(), self.battery.rate_v_s.times(60.0), 3, "V/min"));
        for (axis, bias) in ["x", "y", "z"].iter().zip(&self.accelerometer_bias_m_s2) {
            rows.push((format!("accelerometer bias {axis}"), bias.clone(), 3, "m/s2"));
        }
        rows
    }

    /// Marks a key of the vehicle file as taken from the base vehicle: it has no interval.
    pub(super) fn assume(&mut self, key: &str, why: &str) {
        if let Some(identified) = &mut self.vehicle.identified {
            identified.assumed.insert(key.into(), why.into());
            identified.origin.insert(key.into(), Origin::Base);
            identified.interval.remove(key);
        }
    }

    /// Where a number of the vehicle file comes from.
    pub(super) fn origin(&mut self, key: &str, origin: Origin) {
        if let Some(identified) = &mut self.vehicle.identified {
            identified.origin.insert(key.into(), origin);
        }
    }

    /// A number of the vehicle file that the logs told, and its interval where it has one.
    pub(super) fn found(&mut self, key: &str, interval: Option<Span>) {
        self.origin(key, Origin::Log);
        if let (Some(identified), Some(interval)) = (&mut self.vehicle.identified, interval) {
            identified.interval.insert(key.into(), interval);
        }
    }

    pub(super) fn remark(&mut self, text: String) {
        self.remarks.push(text);
    }
}
