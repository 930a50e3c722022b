//! What a vehicle does beyond the compact model: the sizes of its [`effects`], and how well they are known.

use crate::base::check::{Check, Invalid};
use crate::base::rng::Sequence;
use crate::model::effects::{self, COUNT, MODEL};
use nalgebra::DMatrix;
use rand::RngExt;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Effects of a vehicle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extension {
    /// Where they were found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// By identifier, then by name of the parameter.
    #[serde(default)]
    pub sizes: BTreeMap<String, BTreeMap<String, f64>>,
    /// Parameters as `effect.parameter`, and their covariance in this order: they are drawn jointly with it for each
    /// episode of training. None: they are not randomised.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub uncertain: Vec<String>,
    /// The covariance of `uncertain`, in their units.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub covariance: Vec<Vec<f64>>,
}

/// The index of `effect.parameter` among the numbers of all effects of the simulator.
fn index(effect: &str, parameter: &str) -> Option<usize> {
    let span = effects::span(effect).filter(|span| span.end <= COUNT)?;
    let card = effects::card(effect)?;
    card.parameters.iter().position(|p| p.name == parameter).map(|i| span.start + i)
}

impl Extension {
    /// Whether there are no effects.
    pub fn is_empty(&self) -> bool {
        self.sizes.is_empty()
    }

    /// Sets a size that is known with this standard deviation (0: not randomised), whatever else is known.
    pub fn put(&mut self, effect: &str, parameter: &str, size: f64, deviation: f64) {
        self.sizes.entry(effect.into()).or_default().insert(parameter.into(), size);
        let key = format!("{effect}.{parameter}");
        self.make_certain(|known| *known == key);
        if deviation > 0.0 {
            self.uncertain.push(key);
            self.covariance.iter_mut().for_each(|row| row.push(0.0));
            let alone = (1..self.uncertain.len()).map(|_| 0.0).chain([deviation * deviation]);
            self.covariance.push(alone.collect());
        }
    }

    /// Sizes that are as in `given` are as well known as there.
    pub fn known_as(&mut self, given: &Extension) {
        for (i, key) in given.uncertain.iter().enumerate() {
            let Some((effect, parameter)) = key.split_once('.') else { continue };
            let size = |of: &Extension| of.sizes.get(effect).and_then(|sizes| sizes.get(parameter).copied());
            if let Some(size) = size(given).filter(|_| size(given) == size(self) && !self.uncertain.contains(key)) {
                self.put(effect, parameter, size, given.covariance[i][i].sqrt());
            }
        }
    }

    /// Takes an effect away.
    pub fn remove(&mut self, effect: &str) {
        self.sizes.remove(effect);
        self.make_certain(|known| known.split_once('.').is_some_and(|(of, _)| of == effect));
    }

    /// Forgets how uncertain these parameters are.
    fn make_certain(&mut self, which: impl Fn(&String) -> bool) {
        while let Some(at) = self.uncertain.iter().position(&which) {
            self.uncertain.remove(at);
            self.covariance.remove(at);
            for row in &mut self.covariance {
                row.remove(at);
            }
        }
    }

    /// The parameters of all effects of the simulator, moved by `by`, within their bounds.
    pub fn drawn(&self, by: &[f64; COUNT]) -> [f64; COUNT] {
        let mut out = [0.0; COUNT];
        for (effect, parameters) in &self.sizes {
            for (name, value) in parameters {
                if let (Some(i), Some(card)) = (index(effect, name), effects::card(effect)) {
                    let bounds = card.parameters.iter().find(|p| p.name == name);
                    let moved = value + by[i];
                    out[i] = bounds.map_or(moved, |p| moved.clamp(p.low, p.high));
                }
            }
        }
        out
    }

    /// A draw of what is uncertain, to be added to the parameters.
    pub fn draw(&self, rng: &mut Sequence) -> [f64; COUNT] {
        let mut out = [0.0; COUNT];
        let n = self.uncertain.len();
        if n == 0 {
            return out;
        }
        let covariance = DMatrix::from_fn(n, n, |i, j| self.covariance[i][j]);
        let Some(cholesky) = covariance.cholesky() else { return out };
        let normals: Vec<f64> = rng.sample_iter(StandardNormal).take(n).collect();
        for (row, key) in self.uncertain.iter().enumerate() {
            let moved: f64 = (0..=row).map(|column| cholesky.l_dirty()[(row, column)] * normals[column]).sum();
            if let Some(i) = key.split_once('.').and_then(|(effect, name)| index(effect, name)) {
                out[i] = moved;
            }
        }
        out
    }
}

impl Check for Extension {
    fn check(&self) -> Result<(), Invalid> {
        for (effect, parameters) in &self.sizes {
            let key = format!("sizes.{effect}");
            let Some(card) = MODEL.iter().find(|card| card.id == effect) else {
                let known: Vec<_> = MODEL.iter().map(|card| card.id).collect();
                let advice = match effects::card(effect) {
                    Some(_) => "effects of sensors and of chance do not belong to a vehicle".to_string(),
                    None => format!("the effects are {}", known.join(", ")),
                };
                return Err(Invalid::new(&key, effect, "an effect of the simulator", &advice));
            };
            for (name, value) in parameters {
                let key = format!("{key}.{name}");
                let Some(p) = card.parameters.iter().find(|p| p.name == name) else {
                    let known: Vec<_> = card.parameters.iter().map(|p| p.name).collect();
                    return Err(Invalid::new(&key, name, &format!("one of {}", known.join(", ")), ""));
                };
                let expected = format!("{} to {} {}", p.low, p.high, p.unit);
                Invalid::unless((p.low..=p.high).contains(value), &key, value, &expected, "")?;
            }
        }
        let n = self.uncertain.len();
        for key in &self.uncertain {
            let sized = |(effect, name): (&str, &str)| self.sizes.get(effect).is_some_and(|p| p.contains_key(name));
            let known = key.split_once('.').is_some_and(sized);
            Invalid::unless(known, "uncertain", key, "one of the sizes, as effect.parameter", "")?;
        }
        let square = self.covariance.len() == n && self.covariance.iter().all(|row| row.len() == n);
        Invalid::unless(
            square,
            "covariance",
            format!("{} rows", self.covariance.len()),
            &format!("{n} rows of {n}"),
            "",
        )?;
        let positive = n == 0 || DMatrix::from_fn(n, n, |i, j| self.covariance[i][j]).cholesky().is_some();
        Invalid::unless(positive, "covariance", "another matrix", "a positive definite matrix", "")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_put_in_the_place_of_their_former_selves_and_taken_away() {
        let [a, b, c] = [MODEL[0], MODEL[1], MODEL[2]].map(|card| (card.id, card.parameters[0].name));
        let typical = |i: usize| MODEL[i].parameters[0].typical;
        let mut out = Extension::default();
        out.put(a.0, a.1, typical(0)[0], 1e-3);
        out.put(b.0, b.1, typical(1)[0], 0.02);
        out.put(a.0, a.1, typical(0)[1], 2e-3);
        out.put(c.0, c.1, typical(2)[0], 0.0);
        assert!(out.check().is_ok(), "{out:?}");
        assert_eq!((out.sizes[a.0][a.1], out.sizes[c.0][c.1]), (typical(0)[1], typical(2)[0]));
        assert_eq!(out.uncertain, [b, a].map(|(effect, name)| format!("{effect}.{name}")));
        assert_eq!(out.covariance, [[4e-4, 0.0], [0.0, 4e-6]]);
        out.remove(b.0);
        assert_eq!((out.covariance.clone(), out.sizes.len()), (vec![vec![4e-6]], 2));
        assert!(out.check().is_ok(), "{out:?}");
    }

    #[test]
    fn what_stays_as_given_is_known_as_well_as_before() {
        let [a, b] = [MODEL[0], MODEL[1]].map(|card| (card.id, card.parameters[0].name));
        let mut given = Extension::default();
        given.put(a.0, a.1, 0.01, 1e-3);
        given.put(b.0, b.1, 0.01, 2e-3);
        let mut fitted = Extension::default();
        fitted.put(a.0, a.1, 0.01, 0.0);
        fitted.put(b.0, b.1, 0.02, 0.0);
        fitted.known_as(&given);
        assert_eq!(fitted.uncertain, [format!("{}.{}", a.0, a.1)]);
        assert!((fitted.covariance[0][0] - 1e-6).abs() < 1e-18);
    }
}
