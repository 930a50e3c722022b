//! Numbers of the compact model that moved, and effects that look like nothing but such a move.

use super::cause;
use super::diagnosis::Drift;
use super::finding::Finding;
use crate::base::stats::NORMAL_95;
use crate::insight::criteria::drifted::{
    MOVED_DEVIATIONS, MOVED_DISCHARGE, MOVED_DRAG, MOVED_RATE, MOVED_THRUST, MOVED_TIME_CONSTANT, MOVED_VOLTAGE,
};
use crate::insight::diagnose::prediction::model::Model;
use crate::insight::diagnose::prediction::numbers::{DISCHARGE, DRAG, MAX_RATE, TAU, THRUST};
use crate::insight::diagnose::selection::fitted::FittedSelection;
use std::ops::Range;

/// Numbers that differ from the base vehicle's, and a cause if one explains all of thrust's and drag's moves.
pub fn find(fitted: &FittedSelection) -> (Vec<Drift>, Option<Finding>) {
    let point = &fitted.selection.point;
    let model = &fitted.problem.model;
    let mut out = Vec::new();
    let place = |k: usize| point.free.iter().position(|f| *f == k);
    let mut add = |name: &str, unit, base: f64, value: f64, sd: f64, material: f64, scale: f64| {
        let change = value - base;
        if change.abs() > MOVED_DEVIATIONS.get() * sd && change.abs() > material * base.abs() {
            let half = NORMAL_95 * sd * scale;
            let value = value * scale;
            out.push(Drift {
                parameter: name.into(),
                base: base * scale,
                value,
                low: value - half,
                high: value + half,
                unit,
                in_vehicle: None,
            });
        }
    };
    for (range, material, scale, unit) in single() {
        for k in range {
            let Some(i) = place(k) else { continue };
            let sd = fitted.covariance[(i, i)].max(0.0).sqrt();
            add(&model.numbers[k].name, unit, model.base[k], point.x[k], sd, material, scale);
        }
    }
    let gradient = gradient(model);
    let mut variance = 0.0;
    for a in 0..6 {
        for b in 0..6 {
            if let (Some(i), Some(j)) = (place(THRUST.start + a), place(THRUST.start + b)) {
                variance += gradient[a] * gradient[b] * fitted.covariance[(i, j)];
            }
        }
    }
    let (base, now) = (thrust(model, &model.base), thrust(model, &point.x));
    add(THRUST_AT, "m/s2", base, now, variance.max(0.0).sqrt(), MOVED_THRUST.get(), 1.0);
    let moved = !out.is_empty() || voltage_moved(fitted);
    let cause = if moved { cause::find(fitted) } else { None };
    (out, cause)
}

/// What the thrust over mass is called.
const THRUST_AT: &str = "thrust over mass at 60 % throttle";

/// Numbers by themselves, the share of them that is worth a word, the scale of their unit, and that.
fn single() -> [(Range<usize>, f64, f64, &'static str); 4] {
    [
        (TAU, MOVED_TIME_CONSTANT.get(), 1e3, "ms"),
        (MAX_RATE, MOVED_RATE.get(), 1f64.to_degrees(), "deg/s"),
        (DRAG, MOVED_DRAG.get(), 1.0, "1/m"),
        (DISCHARGE..DISCHARGE + 1, MOVED_DISCHARGE.get(), 60.0, "V/min"),
    ]
}

/// By how much each number of the curve moves the thrust at 60 % throttle and the middle voltage.
fn gradient(model: &Model) -> [f64; 6] {
    let v = model.vehicle().battery;
    let volts = 0.5 * (v.full_v + v.empty_v);
    let u = 0.2;
    [1.0, u, u * u, u * u * u, volts, u * volts]
}

fn thrust(model: &Model, x: &[f64]) -> f64 {
    gradient(model).iter().zip(&x[THRUST]).map(|(g, c)| g * c).sum()
}

/// Says of each number what a vehicle with the numbers `x` has in its place.
pub fn written(drift: &mut [Drift], model: &Model, x: &[f64]) {
    for moved in drift {
        let mut all = single().into_iter().flat_map(|(range, _, scale, _)| range.map(move |k| (k, scale)));
        let own = all.find(|(k, _)| model.numbers[*k].name == moved.parameter);
        moved.in_vehicle = Some(own.map_or_else(|| thrust(model, x), |(k, scale)| x[k] * scale));
    }
}

fn voltage_moved(fitted: &FittedSelection) -> bool {
    let point = &fitted.selection.point;
    let k = THRUST.start + 5;
    let Some(i) = point.free.iter().position(|f| *f == k) else { return false };
    let change = (point.x[k] - fitted.problem.model.base[k]).abs();
    change > MOVED_DEVIATIONS.get() * fitted.covariance[(i, i)].max(0.0).sqrt()
        && change > MOVED_VOLTAGE.get() * fitted.problem.model.base[k].abs()
}
