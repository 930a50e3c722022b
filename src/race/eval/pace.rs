//! A policy's laps beside the reference lap.

use super::Report;
use super::score::Benchmark;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::race::reference::{self, METHOD};
use serde::Serialize;

/// Median laps over the reference lap of the nominal vehicle with a fresh battery. 1 would be a point mass.
#[derive(Clone, Debug, Serialize)]
pub struct Pace {
    /// Time of the reference lap, s, and its battery voltage, V.
    pub reference_s: f64,
    pub voltage_v: f64,
    pub method: &'static str,
    /// Median lap over it, without unit; none where no lap was completed.
    pub fixed: Option<f64>,
    pub random: Option<f64>,
}

impl Pace {
    /// How the laps of `report` on `track` compare. Both are flying laps, from a crossing of the first gate to its
    /// next. None where no reference lap exists.
    pub fn of(report: &Report, track: &Track, vehicle: &Vehicle) -> Option<Self> {
        let reference = reference::lap(track, vehicle, vehicle.battery.full_v)?;
        let ratio = |benchmark: &Option<Benchmark>| Some(benchmark.as_ref()?.lap_time_s?.median / reference.seconds);
        Some(Pace {
            reference_s: reference.seconds,
            voltage_v: reference.voltage,
            method: METHOD,
            fixed: ratio(&report.fixed),
            random: ratio(&report.random),
        })
    }
}
