//! Signals on the IMU's clock, as measured and as the simulator's own equations predict them from what was commanded.

use super::{PredictOptions, drive, together};
use crate::base::stats::mean;
use crate::insight::diagnose::prediction::horizon::{self, Horizon};
use crate::insight::diagnose::prediction::model::Model;
use crate::insight::diagnose::prediction::numbers::{self, BEGIN, TAU};
use crate::insight::diagnose::prediction::predict::Predicted;
use crate::insight::diagnose::prediction::record::{FlightRecord, full_rate};
use crate::insight::prepare::data::Data;
use crate::insight::prepare::flight::PreparedFlight;
use crate::model::effects::{self, ControllerPart};
use crate::model::vehicle::Vehicle;
use crate::model::vehicle::identified::{SensorOffsets, ThrustSource};

/// Flight that shows the voltage that it began with, s.
const BEGINNING_S: f64 = 2.0;

/// Body rates, specific force along each axis, voltage.
pub const CHANNELS: usize = 7;
pub const NAMES: [&str; CHANNELS] =
    ["roll rate", "pitch rate", "yaw rate", "specific force x", "specific force y", "specific force z", "voltage"];
pub const UNITS: [&str; CHANNELS] = ["deg/s", "deg/s", "deg/s", "m/s2", "m/s2", "m/s2", "V"];
pub const VOLTAGE: usize = 6;

/// A lag that is none, s.
const NONE_S: f64 = 1e-9;

/// By channel, by flight, at every sample of its IMU; NaN where it is not known.
pub type Values = [Vec<Vec<f64>>; CHANNELS];

/// A vehicle's prediction of all flights.
pub struct Signals {
    pub channels: Values,
    /// What drives the thrust.
    pub driven_by: ThrustSource,
    model: Model,
    x: Vec<f64>,
    records: Vec<FlightRecord>,
    states: Vec<Predicted>,
}

/// What the sensors read, through the zero-phase filters.
pub fn measured(data: &Data, options: &PredictOptions) -> Values {
    let degrees = 1f64.to_degrees();
    std::array::from_fn(|c| {
        data.signals(|flight| match c {
            0..3 => {
                let rate = flight.measured(c).iter().map(|w| w * degrees).collect();
                flight.smooth(rate, options.rate_cutoff_hz)
            }
            VOLTAGE => voltage(flight),
            _ => flight.smooth(flight.measured(c), options.force_cutoff_hz),
        })
    })
}

/// Voltage as measured, at the one sample that follows each measurement.
fn voltage(flight: &PreparedFlight) -> Vec<f64> {
    let mut out = vec![f64::NAN; flight.time.len()];
    let battery = &flight.quality.log.battery;
    for (t, row) in battery.time_s.iter().zip(&battery.rows) {
        let next = flight.time.partition_point(|time| time <= t);
        if next < out.len() && row[0] > 0.0 {
            out[next] = row[0];
        }
    }
    out
}

/// What `vehicle` predicts of all flights.
pub fn predicted(data: &Data, vehicle: &Vehicle, options: &PredictOptions) -> Signals {
    let mut records: Vec<FlightRecord> = Vec::new();
    let mut begin_v = Vec::new();
    let source = drive::source(data, vehicle);
    for flight in &data.flights {
        let mut record = FlightRecord::at_rate(flight, full_rate(vehicle, &flight.quality), f64::INFINITY);
        drive::apply(source, vehicle, flight, &mut record);
        let first = record.usable.iter().position(|usable| *usable).unwrap_or(0);
        let known = record.voltage.get(first).copied().filter(|v| v.is_finite());
        begin_v.push(known.unwrap_or(vehicle.battery.full_v));
        records.push(record);
    }
    let mut model = Model::new(vehicle, &begin_v);
    if records.iter().any(|r| r.volts.is_empty()) || source == ThrustSource::Speeds {
        model.forget_voltage();
    }
    let mut x = model.base.clone();
    if source == ThrustSource::Speeds {
        x[TAU.start + 3] = NONE_S;
    }
    if source != ThrustSource::Command {
        // What a mixer makes of the command is in its outputs.
        effects::of_controller(ControllerPart::Room).into_iter().for_each(|card| x[numbers::span(card)].fill(0.0));
    }
    let states: Vec<Predicted> =
        records.iter().enumerate().map(|(f, record)| from_beginning(&model, record, f, &mut x)).collect();
    let sensors = vehicle.identified.as_ref().and_then(|i| i.sensors).unwrap_or_default();
    let channels = std::array::from_fn(|c| {
        let one = |f: usize| smoothed(c, &data.flights[f], &records[f], &states[f], &sensors, options);
        (0..records.len()).map(one).collect()
    });
    Signals { channels, driven_by: source, model, x, records, states }
}

/// Predicts `record`, number `flight`. The voltage that it begins with is what the first seconds show: a pack that sags
/// was measured below that.
fn from_beginning(model: &Model, record: &FlightRecord, flight: usize, x: &mut [f64]) -> Predicted {
    let mut state = Predicted::new(model, record, flight, x);
    let begin = BEGIN + flight;
    let first = record.volts.first().map_or(0.0, |(i, _)| record.time[*i]);
    let off = |state: &Predicted| {
        let begins = record.volts.iter().take_while(|(i, _)| record.time[*i] <= first + BEGINNING_S);
        mean(&begins.map(|(i, volts)| volts - state.modelled_v[*i]).collect::<Vec<_>>())
    };
    // Where an effect goes with the charge, the voltage moves by more than the beginning does: once more by a secant.
    let mut last = off(&state);
    let mut by = last;
    for _ in 0..2 {
        x[begin] += by;
        state = state.changed(model.dirty(&[begin], x), model, record, flight, x);
        let now = off(&state);
        by *= now / (last - now);
        last = now;
        if !by.is_finite() {
            break;
        }
    }
    state
}

/// Channel `c` of a flight, through the filter that the measured one passes.
fn smoothed(
    c: usize,
    flight: &PreparedFlight,
    record: &FlightRecord,
    state: &Predicted,
    sensors: &SensorOffsets,
    options: &PredictOptions,
) -> Vec<f64> {
    let [rates, thrust] = record.commanded;
    let unknown = || vec![f64::NAN; flight.time.len()];
    let degrees = 1f64.to_degrees();
    match c {
        0..3 if rates => {
            let rate = state.rates.iter().map(|w| (w[c] + sensors.gyro_rad_s[c]) * degrees).collect();
            flight.smooth(rate, options.rate_cutoff_hz)
        }
        // Without velocity there is no drag to predict, along z either; there thrust is nearly all.
        3..6 if thrust && (record.moves || c == 5) => {
            let force = state.force.iter().map(|f| f[c - 3] + sensors.accelerometer_m_s2[c - 3]).collect();
            flight.smooth(force, options.force_cutoff_hz)
        }
        VOLTAGE if !record.volts.is_empty() => state.modelled_v.to_vec(),
        _ => unknown(),
    }
}

impl Signals {
    /// Errors of the simulation a moment after it was where the flight was, over the `wanted` samples of each flight.
    pub fn ahead(&self, wanted: &[Vec<bool>]) -> Vec<Horizon> {
        let one = |f: usize| {
            let inside = |i: usize| wanted[f][i];
            horizon::errors(&self.model, &self.records[f], &self.states[f], &self.x, &inside)
        };
        together(&(0..self.records.len()).map(one).collect::<Vec<_>>())
    }
}
