//! An effect's parameters as people read them.

use super::finding::Value;
use crate::base::stats::NORMAL_95;
use crate::insight::diagnose::prediction::numbers::{TAU, span};
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::Card;
use std::collections::BTreeMap;

/// The effect's parameters as people read them, with intervals.
pub fn parameters(fitted: &FittedSelection, card: &Card) -> BTreeMap<String, Value> {
    let at = span(card);
    let x = &fitted.point().x;
    let place = |k: usize| fitted.point().free.iter().position(|f| *f == k);
    let places: Vec<(usize, usize)> = at.clone().enumerate().filter_map(|(i, k)| Some((i, place(k)?))).collect();
    let tau_places = TAU.map(place);
    let tau_places: Vec<(usize, usize)> = tau_places.enumerate().filter_map(|(i, at)| Some((i, at?))).collect();
    let values: Vec<f64> = at.clone().map(|k| x[k]).collect();
    let shown = |k: &[f64], tau: [f64; 4]| -> Vec<(String, f64, String)> {
        match card.shown {
            Some(shown) => shown(k, tau).into_iter().map(|(n, v, u)| (n.to_string(), v, u.to_string())).collect(),
            None => card.parameters.iter().zip(k).map(|(p, v)| (p.name.to_string(), *v, p.unit.to_string())).collect(),
        }
    };
    let tau: [f64; 4] = std::array::from_fn(|i| x[TAU.start + i]);
    let here = shown(&values, tau);
    // By how much each shown value changes with the fitted ones (delta method).
    let mut out = BTreeMap::new();
    let fitted_too = |i: usize| !card.forms.contains(&i) || places.iter().any(|(fitted, _)| *fitted == i);
    for (i, (name, value, unit)) in here.iter().enumerate().filter(|(i, _)| fitted_too(*i)) {
        let mut slopes: Vec<(usize, f64)> = Vec::new();
        for &(j, place) in &places {
            let step = 1e-4 * card.parameters[j].typical[0];
            let mut moved = values.clone();
            moved[j] += step;
            slopes.push((place, (shown(&moved, tau)[i].1 - value) / step));
        }
        for &(j, place) in &tau_places {
            let mut moved = tau;
            moved[j] += 1e-6;
            slopes.push((place, (shown(&values, moved)[i].1 - value) / 1e-6));
        }
        let variance: f64 = slopes
            .iter()
            .flat_map(|a| slopes.iter().map(move |b| (a, b)))
            .map(|(a, b)| a.1 * b.1 * fitted.covariance[(a.0, b.0)])
            .sum();
        let half = NORMAL_95 * variance.max(0.0).sqrt();
        out.insert(name.clone(), Value { value: *value, low: value - half, high: value + half, unit: unit.clone() });
    }
    out
}
