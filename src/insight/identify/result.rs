//! What an identification found: the vehicle, and everything to judge it by.

use super::estimate::Estimate;
use super::rates::Compared;
use super::{AXES, IdentifyOptions, fastest};
use crate::base::stats::Score;
use crate::flight::spans::Span;
use crate::insight::prepare::data::Data;
use crate::model::vehicle::{Identified, LogSpan, Vehicle};
use serde::Serialize;

/// A first-order response: a row of the paper's Table 1. Scores are those of the validation part.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Response {
    /// Time constant, s.
    pub tau_s: Estimate,
    /// Constant that the measurement has too much, in `unit`.
    pub offset: Estimate,
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
    pub k_1_m: [Estimate; 3],
    /// The ellipsoid with these, given its coefficient.
    pub semi_axes_m: Option<[f64; 3]>,
    /// The base vehicle's drag coefficient, without unit.
    pub coefficient: Option<f64>,
    /// 99 % of the speed in flight, m/s.
    pub flown_m_s: Option<f64>,
}

impl DragEstimate {
    pub(super) fn unknown(&mut self, why: &str) {
        self.k_1_m = std::array::from_fn(|_| Estimate::unknown(why));
    }
}

/// Discharge.
#[derive(Clone, Debug, Default, Serialize)]
pub struct BatteryEstimate {
    /// Voltage at the start, V.
    pub initial_v: Estimate,
    /// Change of the voltage, V/s.
    pub rate_v_s: Estimate,
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
    pub(super) fn new(name: &str, unit: &'static str, scale: f64, train: &Compared, validation: &Compared) -> Self {
        let scaled = |x: &Compared| Compared {
            time: x.time.clone(),
            measured: x.measured.iter().map(|v| v * scale).collect(),
            predicted: x.predicted.iter().map(|v| v * scale).collect(),
        };
        ComparedChannel { name: name.into(), unit, train: scaled(train), validation: scaled(validation) }
    }
}

/// Everything that was found.
#[derive(Clone, Debug)]
pub struct Identification {
    /// What `train` reads.
    pub vehicle: Vehicle,
    /// Roll, pitch, yaw, thrust.
    pub response: [Response; 4],
    /// Body rates at full command, rad/s.
    pub max_rate_rad_s: [Estimate; 3],
    /// c0..c5 of Eq. 7 for the command in [-1, 1], N.
    pub thrust_n: [Estimate; 6],
    /// Drag.
    pub drag: DragEstimate,
    /// Discharge.
    pub battery: BatteryEstimate,
    /// Constant error of the accelerometer along x, y, z, m/s2.
    pub accelerometer_bias_m_s2: [Estimate; 3],
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
        vehicle.name = data.flights.first().map_or("identified", |f| &f.quality.log.name).to_string();
        let spans = data.flights.iter().map(|flight| {
            let usable = &flight.quality.usable;
            let span: Option<Span> = usable.first().zip(usable.last()).map(|(first, last)| [first[0], last[1]]);
            LogSpan { name: flight.quality.log.name.clone(), span_s: span.unwrap_or_default() }
        });
        let said = data.flights.iter().find_map(|flight| flight.quality.log.vehicle.max_rate_rad_s);
        let full_rate_rad_s = options.max_rate_rad_s.or(said).unwrap_or(options.base.max_rates_rad_s());
        vehicle.identified = Some(Identified {
            racer: env!("CARGO_PKG_VERSION").into(),
            base: options.base.name.clone(),
            logs: spans.collect(),
            full_rate_deg_s: full_rate_rad_s.map(f64::to_degrees),
            assumed: Default::default(),
            interval: Default::default(),
        });
        let mut out = Self {
            vehicle,
            response: Default::default(),
            max_rate_rad_s: Default::default(),
            thrust_n: Default::default(),
            drag: Default::default(),
            battery: Default::default(),
            accelerometer_bias_m_s2: Default::default(),
            full_rate_rad_s,
            flown: None,
            fastest_m_s: fastest(data),
            usable_s: data.usable_s(),
            remarks: Vec::new(),
            channels: Vec::new(),
        };
        if options.max_rate_rad_s.or(said).is_none() {
            out.remark("full-stick rates: neither the logs nor an option say them; taken from the base vehicle".into());
        }
        let said = data.flights.iter().find_map(|flight| flight.quality.log.vehicle.mass_kg);
        match options.mass_kg.or(said) {
            Some(mass) => out.vehicle.mass_kg = mass,
            None => out.assume("mass_kg", "a flight does not tell it: weigh the vehicle and give --mass"),
        }
        out
    }

    /// Every parameter but the responses, as people read it: name, estimate, digits, unit.
    pub fn parameters(&self) -> Vec<(String, Estimate, usize, &'static str)> {
        let mut rows = Vec::new();
        for (axis, rate) in AXES.iter().zip(&self.max_rate_rad_s) {
            rows.push((format!("maximum {axis} rate"), rate.times(1f64.to_degrees()), 1, "deg/s"));
        }
        for (k, c) in self.thrust_n.iter().enumerate() {
            rows.push((format!("thrust c{k}"), c.clone(), 3, if k < 4 { "N" } else { "N/V" }));
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

    /// Marks a key of the vehicle file as taken from the base vehicle.
    pub(super) fn assume(&mut self, key: &str, why: &str) {
        if let Some(identified) = &mut self.vehicle.identified {
            identified.assumed.insert(key.into(), why.into());
        }
    }

    /// Keeps an interval in the vehicle file.
    pub(super) fn remember(&mut self, key: &str, interval: Option<Span>) {
        if let (Some(identified), Some(interval)) = (&mut self.vehicle.identified, interval) {
            identified.interval.insert(key.into(), interval);
        }
    }

    pub(super) fn remark(&mut self, text: String) {
        self.remarks.push(text);
    }
}
