//! From flight logs to a vehicle (paper section 4.1 and Table 1).
//!
//! Each part of the model is fitted on the first 70 % of the flight and validated on the rest; the values are then
//! fitted once more on all of it. What the logs cannot tell is taken from a base vehicle, and marked.

pub mod battery;
pub mod bias;
pub mod document;
pub mod estimate;
mod fill;
pub mod fits;
pub mod force;
pub mod force_terms;
mod full_stick;
pub mod inputs;
pub mod judge;
pub mod law;
pub mod mixer;
pub mod nearest;
pub mod rate_loop;
pub mod rates;
pub mod refuse;
pub mod result;
pub mod room;
pub mod solve;
pub mod thrust;

use crate::base::check::{Check, Invalid};
use crate::base::stats::quantile;
use crate::insight::Watch;
use crate::insight::predict::{PredictOptions, predict};
use crate::insight::prepare::data::{Data, DataPart};
use crate::insight::quality::Quality;
use crate::model::vehicle::Vehicle;
use fits::Fits;
use result::Identification;

/// Usual cut-offs: above what a vehicle's rates can follow, and below where the rotors shake the accelerometer.
pub const RATE_CUTOFF_HZ: f64 = 100.0;
pub const FORCE_CUTOFF_HZ: f64 = 30.0;

/// How to identify.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifyOptions {
    /// Where values come from that the logs cannot tell.
    pub base: Vehicle,
    /// Mass, kg; none: what the logs say, else the base vehicle's.
    pub mass_kg: Option<f64>,
    /// Body rates that a full stick asks for, rad/s; none: what the logs say, else the base vehicle's.
    pub max_rate_rad_s: Option<[f64; 3]>,
    /// Cut-off of the zero-phase filter on rates, measured and predicted, Hz.
    pub rate_cutoff_hz: f64,
    /// The same for specific force.
    pub force_cutoff_hz: f64,
    /// Whether a vehicle of which rates or thrust could not be told at all is better than none.
    pub partial: bool,
}

impl IdentifyOptions {
    /// The base vehicle lends what the logs cannot tell; everything else as usual.
    pub fn new(base: Vehicle) -> Self {
        let (rate_cutoff_hz, force_cutoff_hz) = (RATE_CUTOFF_HZ, FORCE_CUTOFF_HZ);
        Self { base, mass_kg: None, max_rate_rad_s: None, rate_cutoff_hz, force_cutoff_hz, partial: false }
    }
}

impl Check for IdentifyOptions {
    fn check(&self) -> Result<(), Invalid> {
        Invalid::unless_positive("--mass", self.mass_kg.unwrap_or(1.0), "")?;
        Invalid::unless_positive("--rate-cutoff", self.rate_cutoff_hz, "")?;
        Invalid::unless_positive("--force-cutoff", self.force_cutoff_hz, "")
    }
}

/// Identifies one vehicle from its flights.
pub fn identify(logs: Vec<Quality>, options: &IdentifyOptions, watch: Watch) -> Identification {
    let data = Data::new(logs);
    let mut out = Identification::new(&data, options);
    let start = out.vehicle.clone();
    let full_rate = out.full_rate_rad_s;
    let mut drag = true;
    watch("the form of the response", 0.0);
    let form = rate_loop::form(&data, options.rate_cutoff_hz);
    loop {
        watch("the first part of the flight", if drag { 0.0 } else { 0.5 });
        let train = Fits::new(&data, DataPart::Train, &start, options, drag, form);
        watch("all of the flight", if drag { 0.25 } else { 0.7 });
        let all = Fits::new(&data, DataPart::All, &start, options, drag, form);
        watch("validation", if drag { 0.45 } else { 0.9 });
        out.validated = train.vehicle(&data, DataPart::Train, &start, &train.everything(), full_rate);
        let predicted = [DataPart::Train, DataPart::Validation].map(|part| {
            let (rate_cutoff_hz, force_cutoff_hz) = (options.rate_cutoff_hz, options.force_cutoff_hz);
            predict(&data, &[&out.validated], &PredictOptions { part, rate_cutoff_hz, force_cutoff_hz })
        });
        let whole = all.vehicle(&data, DataPart::All, &start, &all.everything(), full_rate);
        let highest = all.thrust.as_ref().map_or(1.0, |fit| fit.flown[1].min(1.0));
        let [full, flown] = [1.0, highest].map(|u| fill::thrust::thrust_of(&all, &whole, u));
        let judged = judge::judge(&all, &predicted[1], &flown);
        if drag && all.everything().drag && !judged.kept.drag && judged.kept.thrust {
            // The thrust beside a drag that is not the vehicle's would be another thrust.
            drag = false;
            continue;
        }
        out.vehicle = all.vehicle(&data, DataPart::All, &start, &judged.kept, full_rate);
        fill::fill(&mut out, &data, &all, &predicted, judged, full, options);
        watch("done", 1.0);
        return out;
    }
}

/// 99 % of the speed in flight, m/s; none without velocity.
fn fastest(data: &Data) -> Option<f64> {
    let mut speeds = Vec::new();
    for flight in &data.flights {
        for i in (0..flight.time.len()).filter(|&i| flight.usable[i]) {
            speeds.push((0..3).map(|k| flight.velocity[k][i].powi(2)).sum::<f64>().sqrt());
        }
    }
    speeds.retain(|v| v.is_finite());
    (!speeds.is_empty()).then(|| quantile(&speeds, 0.99))
}
