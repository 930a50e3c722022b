//! What an effect does to a flight.

use crate::base::stats::mean;
use crate::insight::diagnose::prediction::horizon;
use crate::insight::diagnose::prediction::problem::ChannelValues;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::constants::GRAVITY_M_S2;
use crate::model::effects::{Card, EffectKind};

/// How far apart simulations with and without the effect are after a second, m/s; for sensors, what the error
/// integrates to.
pub fn impact(fitted: &FittedSelection, card: &Card, without: &[f64], change: &ChannelValues) -> f64 {
    let sensors = integrated(change);
    if matches!(card.kind, EffectKind::Sensor | EffectKind::Random) {
        return sensors;
    }
    let model = &fitted.problem.model;
    let state = fitted.problem.predict(without);
    let with = &fitted.point().state;
    let distances = fitted
        .problem
        .records
        .iter()
        .enumerate()
        .map(|(f, record)| horizon::apart(model, record, (&with[f], &fitted.point().x), (&state[f], without)));
    let apart = distances.fold(0.0, f64::max);
    if apart > 0.0 { apart } else { sensors }
}

/// What an error of the sensors integrates to in a second, m/s, or a change of the prediction in as long.
pub fn integrated(change: &ChannelValues) -> f64 {
    let rms = |c: usize| mean(&change[c].iter().map(|x| x * x).collect::<Vec<_>>()).sqrt();
    (0..3)
        .map(|k| rms(k) * 0.5 * GRAVITY_M_S2)
        .chain((3..6).map(rms))
        .chain((6..9).map(|c| rms(c) * 4.0 * 0.5 * GRAVITY_M_S2))
        .chain((9..12).map(|c| rms(c) * 4.0))
        .fold(0.0, f64::max)
}
