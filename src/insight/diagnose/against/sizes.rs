//! A cause as people read it, before, after and the difference of the two, with intervals by the delta method.

use super::suspect::Suspect;
use crate::insight::diagnose::judgement::finding::Value;
use crate::insight::diagnose::prediction::numbers::{DISCHARGE, MAX_RATE, TAU, THRUST};
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::vehicle::Vehicle;
use std::collections::BTreeMap;

/// A cause before and after.
pub struct SizesOfSets {
    pub before: BTreeMap<String, Value>,
    pub after: BTreeMap<String, Value>,
    pub difference: BTreeMap<String, Value>,
}

/// The thrust is shown at this command, -1..1.
const COMMAND: f64 = 0.2;

/// The sizes of a suspect.
pub fn of(fitted: &FittedSelection, suspect: &Suspect) -> SizesOfSets {
    let flights = [0, fitted.problem.records.len() - 1];
    let at = |x: &[f64]| flights.map(|f| shown(fitted, suspect, &fitted.problem.numbers(f, x)));
    let point = fitted.point();
    let here = at(&point.x);
    let slopes: Vec<[Vec<f64>; 2]> = point
        .free
        .iter()
        .map(|&k| {
            let step = 1e-2 * fitted.problem.model.numbers[k].step;
            let mut x = point.x.clone();
            x[k] += step;
            let moved = at(&x);
            std::array::from_fn(|s| moved[s].iter().zip(&here[s]).map(|(m, h)| (m.1 - h.1) / step).collect())
        })
        .collect();
    let sd = |slope: &dyn Fn(&[Vec<f64>; 2]) -> f64| {
        let g = nalgebra::DVector::from_iterator(slopes.len(), slopes.iter().map(slope));
        (g.transpose() * &fitted.covariance * &g)[(0, 0)].max(0.0).sqrt()
    };
    let value = |i: usize, value: f64, sd: f64| {
        let (name, _, unit) = &here[0][i];
        (name.clone(), Value::measured(value, sd, unit))
    };
    let set = |s: usize| (0..here[s].len()).map(|i| value(i, here[s][i].1, sd(&|g| g[s][i]))).collect();
    let apart = |i: usize| value(i, here[1][i].1 - here[0][i].1, sd(&|g| g[1][i] - g[0][i]));
    SizesOfSets { before: set(0), after: set(1), difference: (0..here[0].len()).map(apart).collect() }
}

/// The largest share by which a number of the compact model differs.
pub fn share(fitted: &FittedSelection, suspect: &Suspect) -> f64 {
    let x = &fitted.point().x;
    let last = fitted.problem.records.len() - 1;
    let (before, after) = (fitted.problem.numbers(0, x), fitted.problem.numbers(last, x));
    suspect.numbers.clone().map(|k| (after[k] / before[k] - 1.0).abs()).filter(|s| s.is_finite()).fold(0.0, f64::max)
}

/// Names, values and units of a suspect at these numbers of a flight.
fn shown(fitted: &FittedSelection, suspect: &Suspect, x: &[f64]) -> Vec<(String, f64, String)> {
    let k = &x[suspect.numbers.clone()];
    if let Some(card) = suspect.card {
        return match card.shown {
            Some(shown) => shown(k, std::array::from_fn(|i| x[TAU.start + i]))
                .into_iter()
                .map(|(name, value, unit)| (name.to_string(), value, unit.to_string()))
                .collect(),
            None => card.parameters.iter().zip(k).map(|(p, v)| (p.name.to_string(), *v, p.unit.to_string())).collect(),
        };
    }
    let model = &fitted.problem.model;
    if suspect.numbers == THRUST {
        return vec![("thrust over mass at 60 % throttle".into(), thrust(model.vehicle(), k), "m/s2".into())];
    }
    let (scale, unit) = match suspect.numbers.start {
        at if TAU.contains(&at) => (1e3, "ms"),
        at if MAX_RATE.contains(&at) => (1f64.to_degrees(), "deg/s"),
        DISCHARGE => (60.0, "V/min"),
        _ => (1.0, "1/m"),
    };
    let name = |k: usize| model.numbers[k].name.clone();
    suspect.numbers.clone().map(|k| (name(k), x[k] * scale, unit.to_string())).collect()
}

/// Thrust over mass, m/s2, of a half full pack.
fn thrust(vehicle: &Vehicle, c: &[f64]) -> f64 {
    let (u, volts) = (COMMAND, 0.5 * (vehicle.battery.full_v + vehicle.battery.empty_v));
    let factors = [1.0, u, u * u, u * u * u, volts, u * volts];
    c.iter().zip(factors).map(|(c, factor)| c * factor).sum()
}
