//! An identification as JSON.

use super::estimate::Estimated;
use super::result::{BatteryEstimate, DragEstimate, Identification, Response, ThrustEstimate};
use crate::insight::quality::{LogFinding, StreamSummary};
use crate::model::effects::of_controller;
use crate::model::vehicle::{AXES, Vehicle};
use serde::Serialize;
use std::collections::BTreeMap;

/// What `racer identify --json` writes. A value that the logs cannot tell is null, with a `why`.
#[derive(Serialize)]
pub struct IdentificationDocument<'a> {
    racer: &'a str,
    logs: Vec<CheckedLog<'a>>,
    /// Usable flight of all logs, s.
    usable_s: f64,
    /// By axis and for the thrust; `rmse` and `mae` in `unit`, on the validation part.
    response: BTreeMap<&'a str, &'a Response>,
    max_rate_rad_s: BTreeMap<&'a str, &'a Estimated>,
    /// c0..c5 of the paper's Eq. 7, N.
    thrust_coefficients: &'a [Estimated; 6],
    thrust: &'a ThrustEstimate,
    /// 1 and 99 % of the thrust command in flight, -1..1.
    thrust_flown: Option<[f64; 2]>,
    /// What the flight controller makes of commands beyond a lag: first parameters of effects, by the effects' names.
    effects: BTreeMap<&'a str, &'a Estimated>,
    drag: &'a DragEstimate,
    battery: &'a BatteryEstimate,
    accelerometer_bias_m_s2: &'a [Estimated; 3],
    remarks: &'a [String],
    vehicle: &'a Vehicle,
}

/// A log and what its check found.
#[derive(Serialize)]
pub struct CheckedLog<'a> {
    pub name: &'a str,
    pub streams: &'a [StreamSummary],
    pub findings: &'a [LogFinding],
}

impl<'a> IdentificationDocument<'a> {
    pub fn new(found: &'a Identification, logs: Vec<CheckedLog<'a>>) -> Self {
        IdentificationDocument {
            racer: env!("CARGO_PKG_VERSION"),
            logs,
            usable_s: found.usable_s,
            response: AXES.into_iter().chain(["thrust"]).zip(&found.response).collect(),
            max_rate_rad_s: AXES.into_iter().zip(&found.max_rate_rad_s).collect(),
            thrust_coefficients: &found.thrust_n,
            thrust: &found.thrust,
            thrust_flown: found.flown,
            effects: found
                .controller
                .iter()
                .filter_map(|(part, size)| Some((of_controller(*part)?.id, size)))
                .collect(),
            drag: &found.drag,
            battery: &found.battery,
            accelerometer_bias_m_s2: &found.accelerometer_bias_m_s2,
            remarks: &found.remarks,
            vehicle: &found.vehicle,
        }
    }
}
