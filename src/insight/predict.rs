//! What a finished vehicle says of flights: measured beside predicted, without fitting anything.
//!
//! The figures of an identification are made here too, so that they can be had again from a vehicle file and the logs.

pub mod drive;
pub mod rms_change;
pub mod signals;

use crate::base::stats::Score;
use crate::insight::diagnose::prediction::horizon::{AT_S, Horizon};
use crate::insight::prepare::data::{Chosen, Data, DataPart};
use crate::model::vehicle::Vehicle;
use rms_change::{RmsChange, by_stretch};
use signals::{CHANNELS, NAMES, Signals, UNITS};

/// How signals are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictOptions {
    /// Which samples.
    pub part: DataPart,
    /// Cut-off of the zero-phase filter on rates, measured and predicted, Hz.
    pub rate_cutoff_hz: f64,
    /// The same for specific force.
    pub force_cutoff_hz: f64,
}

/// One signal, measured, and predicted by each vehicle, at the same samples of all flights.
#[derive(Clone, Debug)]
pub struct PredictedChannel {
    /// What was measured, such as `roll rate`.
    pub name: &'static str,
    /// Of its numbers.
    pub unit: &'static str,
    /// The flight of each sample, in the order given.
    pub flight: Vec<usize>,
    /// s since the start of its log.
    pub time_s: Vec<f64>,
    /// What the sensor read.
    pub measured: Vec<f64>,
    /// By vehicle.
    pub predicted: Vec<Vec<f64>>,
}

impl PredictedChannel {
    /// How well vehicle number `vehicle` predicts.
    pub fn score(&self, vehicle: usize) -> Score {
        Score::of(&self.measured, &self.predicted[vehicle])
    }

    /// By which share the RMS of vehicle number `vehicle` differs from the first one's.
    pub fn change(&self, vehicle: usize) -> Option<RmsChange> {
        let squares = |predicted: &[f64]| {
            let each = self.measured.iter().zip(predicted).map(|(m, p)| (m - p).powi(2));
            by_stretch(&self.flight, &self.time_s, each)
        };
        RmsChange::of(&squares(&self.predicted[0]), &squares(&self.predicted[vehicle]))
    }
}

/// Flights as predicted by vehicles.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// Names of the vehicles.
    pub vehicles: Vec<String>,
    /// Names of the logs, and when each starts, ns.
    pub logs: Vec<(String, u64)>,
    /// Signals that were measured and that every vehicle predicts.
    pub channels: Vec<PredictedChannel>,
    /// By vehicle: how far off its simulation is a moment after it was where the flight was. Empty without velocity.
    pub ahead: Vec<Vec<Horizon>>,
    /// By vehicle: what drives its thrust.
    pub driven_by: Vec<&'static str>,
}

/// Applies each of `vehicles` to the flights.
pub fn predict(data: &Data, vehicles: &[&Vehicle], options: &PredictOptions) -> Prediction {
    let measured = signals::measured(data, options);
    let all: Vec<Signals> = vehicles.iter().map(|vehicle| signals::predicted(data, vehicle, options)).collect();
    let wanted = membership(data, options.part);
    let ahead = all.iter().map(|signals| signals.ahead(&wanted)).collect();
    let channel = |c: usize| channel(data, c, options.part, &measured, &all);
    Prediction {
        vehicles: vehicles.iter().map(|vehicle| vehicle.name.clone()).collect(),
        logs: data.flights.iter().map(|f| (f.quality.log.name.clone(), f.quality.log.start_ns)).collect(),
        channels: (0..CHANNELS).filter_map(channel).collect(),
        ahead,
        driven_by: all.iter().map(|signals| signals.driven_by.name()).collect(),
    }
}

/// Whether each sample of each flight belongs to `part`.
fn membership(data: &Data, part: DataPart) -> Vec<Vec<bool>> {
    let chosen: Chosen = data.choose(part, |_, _| true);
    let mut out: Vec<Vec<bool>> = data.flights.iter().map(|f| vec![false; f.time.len()]).collect();
    for (out, chosen) in out.iter_mut().zip(&chosen) {
        chosen.iter().for_each(|&i| out[i] = true);
    }
    out
}

/// Channel `c` where it was measured and all vehicles predict it; `None` where there is no such sample.
fn channel(
    data: &Data,
    c: usize,
    part: DataPart,
    measured: &[Vec<Vec<f64>>; CHANNELS],
    all: &[Signals],
) -> Option<PredictedChannel> {
    let known = |f: usize, i: usize| {
        measured[c][f][i].is_finite() && all.iter().all(|signals| signals.channels[c][f][i].is_finite())
    };
    let chosen = data.choose(part, known);
    let times = data.signals(|flight| flight.time.clone());
    let time_s = Data::pick(&times, &chosen);
    (!time_s.is_empty()).then(|| PredictedChannel {
        name: NAMES[c],
        unit: UNITS[c],
        flight: chosen.iter().enumerate().flat_map(|(f, chosen)| vec![f; chosen.len()]).collect(),
        time_s,
        measured: Data::pick(&measured[c], &chosen),
        predicted: all.iter().map(|signals| Data::pick(&signals.channels[c], &chosen)).collect(),
    })
}

/// Root mean squares over the starts of all flights, from those of each.
fn together(flights: &[Vec<Horizon>]) -> Vec<Horizon> {
    let at = |k: usize| {
        let all: Vec<&Horizon> = flights.iter().filter_map(|f| f.get(k)).collect();
        let starts: usize = all.iter().map(|h| h.starts).sum();
        let mean = |of: fn(&Horizon) -> f64| {
            let squares: f64 = all.iter().map(|h| of(h).powi(2) * h.starts as f64).sum();
            (squares / starts.max(1) as f64).sqrt()
        };
        Horizon {
            after_s: AT_S[k],
            velocity_m_s: mean(|h| h.velocity_m_s),
            position_m: mean(|h| h.position_m),
            attitude_deg: mean(|h| h.attitude_deg),
            starts,
        }
    };
    let ahead: Vec<Horizon> = (0..AT_S.len()).map(at).collect();
    if ahead.iter().all(|h| h.starts == 0) { Vec::new() } else { ahead }
}
