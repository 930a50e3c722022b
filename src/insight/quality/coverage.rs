//! Which parameters of the model a log can tell, by the channels it has and what was flown.

use super::Quality;
use crate::base::stats::quantile;
use crate::flight::Log;
use crate::flight::series::{held, interpolated};
use crate::flight::spans::{Span, contain, length};
use crate::insight::criteria::flown::{
    DISCHARGE_S, DRAG_SPEED_M_S, LEAST_FLIGHT_S, RATE_SPREAD, THRUST_SPREAD, VOLTAGE_SPREAD,
};
use serde::Serialize;

/// A group of parameters, and whether the log tells them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterCoverage {
    /// What people call it.
    pub name: &'static str,
    /// Why the log cannot tell it; none where it can.
    pub why_not: Option<String>,
}

/// The model's parameters in the order of its equations.
pub fn told(log: &Log, usable: &[Span]) -> Vec<ParameterCoverage> {
    let times: Vec<f64> = log.imu.time_s.iter().copied().filter(|&t| contain(usable, t)).collect();
    // 5 to 95 % of a signal in flight, if it was measured.
    let range = |x: Vec<f64>| {
        let x: Vec<f64> = x.into_iter().filter(|x| x.is_finite()).collect();
        (!x.is_empty()).then(|| (quantile(&x, 0.05), quantile(&x, 0.95)))
    };
    let command = |k: usize| range(held(&log.setpoint.time_s, &log.setpoint.column(k), &times));
    let along = |k: usize| range(interpolated(&log.odometry.time_s, &log.odometry.column(k), &times, 0.5));
    let voltage = range(interpolated(&log.battery.time_s, &log.battery.column(0), &times, 5.0));
    let flown = length(usable);
    let brief = (flown < LEAST_FLIGHT_S.get()).then(|| format!("only {flown:.1} s of usable flight"));

    let spread = |range: Option<(f64, f64)>, least: f64, unit: &str, what: &str| match range {
        None => Some(format!("no {what} in the log")),
        Some((low, high)) if high - low < least => {
            Some(format!("the {what} hardly varies: {low:.2} to {high:.2} {unit} (5 to 95 %)"))
        }
        Some(_) => None,
    };
    let mut out = Vec::new();
    let mut tell =
        |name, why_not: Option<String>| out.push(ParameterCoverage { name, why_not: brief.clone().or(why_not) });
    for (k, name) in ["roll response", "pitch response", "yaw response"].into_iter().enumerate() {
        tell(name, spread(command(k), RATE_SPREAD.get(), "rad/s", "rate setpoint"));
    }
    let no_force = log.imu.rows.iter().all(|row| !row[5].is_finite());
    let no_force = no_force.then(|| "no specific force in the log".to_string());
    let thrust = no_force.clone().or_else(|| spread(command(3), THRUST_SPREAD.get(), "of 1", "thrust command"));
    tell("thrust response", thrust.clone());
    tell("thrust curve", thrust.clone());
    tell(
        "thrust over voltage",
        thrust
            .or_else(|| spread(voltage, VOLTAGE_SPREAD.get() * voltage.map_or(0.0, |(_, high)| high), "V", "voltage")),
    );
    let least_speed = DRAG_SPEED_M_S.get();
    let speed = |ks: &[usize]| {
        let most = ks.iter().filter_map(|&k| along(k)).map(|(low, high)| high.max(-low)).reduce(f64::max);
        match most {
            None => Some("no velocity in the log".to_string()),
            Some(most) if most < least_speed => {
                Some(format!("flown too slowly: {most:.1} m/s (95 %), drag needs {least_speed:.0}"))
            }
            Some(_) => None,
        }
    };
    tell("drag", no_force.or_else(|| speed(&[7, 8])));
    let short = (flown < DISCHARGE_S.get()).then(|| format!("{flown:.0} s are too short for a discharge rate"));
    tell("battery", spread(voltage, 0.0, "V", "voltage").or(short));
    out
}

impl Quality {
    /// Why the log cannot tell the parameter of this name; none where it can.
    pub fn why_not(&self, name: &str) -> Option<String> {
        self.parameters.iter().find(|parameter| parameter.name == name)?.why_not.clone()
    }
}
