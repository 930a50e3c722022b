//! From the fit to findings: evidence, replication, size and what is left.

use super::finding::{Finding, Status, Value};
use super::fit::{FitPoint, covariance};
use super::horizon;
use super::numbers::{TAU, span};
use super::predict::{CHANNELS, kind};
use super::problem::{ChannelValues, Problem};
use super::score::score;
use super::select::{Added, Selection};
use super::size::{is_bounded, is_material};
use super::structure::NAMES;
use crate::base::stats::{NORMAL_95, mean};
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use crate::model::constants::GRAVITY_M_S2;
use crate::model::effects::{Card, EffectKind};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// Stretches of flight that have to agree before an effect is named.
pub const REPLICATED: f64 = 15.0;
/// Standard deviations that its size has to be.
const SURE: f64 = 4.0;
/// An effect that is rarely flown is also named where at least so many stretches show it by themselves, hold at least this share of all that the flight
/// tells of it, and its size is so many standard deviations.
const RARE: (f64, f64, f64) = (4.0, 0.7, 6.0);

/// Everything linear about the end of a selection.
pub struct Judge<'a> {
    pub problem: &'a Problem,
    pub selection: &'a Selection,
    pub covariance: DMatrix<f64>,
    grams: Grams,
}

/// How often an effect was seen, and how many standard deviations its size is.
#[derive(Clone, Copy, Debug, Default)]
struct Replicated {
    count: f64,
    /// Stretches that show it by themselves, and their share of the information.
    alone: f64,
    held: f64,
    sure: f64,
}

impl Replicated {
    fn evident(&self) -> bool {
        let rarely = self.alone >= RARE.0 && self.held >= RARE.1 && self.sure >= RARE.2;
        self.count >= REPLICATED && self.sure >= SURE || rarely
    }
}

/// A judged effect, and the numbers of the model without it.
pub struct Judged {
    pub finding: Finding,
    pub material: bool,
    /// Whether a number of it ends at the bound of its range.
    pub bounded: bool,
    /// How the fitted numbers move where the effect is left out.
    pub change: Vec<f64>,
}

impl<'a> Judge<'a> {
    pub fn new(problem: &'a Problem, selection: &'a Selection) -> Self {
        let point = &selection.point;
        let residual = selection.whitener.apply(&point.residual, &problem.rows);
        let columns: Vec<&ChannelValues> = point.white.iter().chain([&residual]).collect();
        let grams = Grams::new(&columns, &problem.rows, problem.blocks);
        let n = point.free.len();
        let covariance = covariance(problem, &selection.whitener, point).unwrap_or(DMatrix::zeros(n, n));
        Self { problem, selection, covariance, grams }
    }

    fn point(&self) -> &FitPoint {
        &self.selection.point
    }

    /// Places of an effect's numbers among the fitted ones.
    pub fn places(&self, card: &Card) -> Vec<usize> {
        span(card).filter_map(|k| self.point().free.iter().position(|f| *f == k)).collect()
    }

    /// How many stretches of flight agree on the effect. Either all do a little (the robust score of leaving it out counts them), or a few do by
    /// themselves, beyond two standard deviations, less those that contradict; with how sure all together are.
    fn stretches(&self, card: &Card) -> Replicated {
        let own = self.places(card);
        if own.is_empty() {
            return Replicated::default();
        }
        let n = self.point().free.len();
        let rest: Vec<usize> = (0..n).filter(|i| !own.contains(i)).collect();
        // The residual as it was without the effect.
        let mut grams = self.grams.clone();
        let sizes: Vec<(usize, f64)> = own.iter().map(|&i| (i, self.point().x[self.point().free[i]])).collect();
        for gram in grams.blocks.iter_mut().chain([&mut grams.sum]) {
            for &(i, size) in &sizes {
                for j in 0..=n {
                    let along = gram[(i, j)] * size;
                    gram[(n, j)] += along;
                }
                for j in 0..=n {
                    let along = gram[(j, i)] * size;
                    gram[(j, n)] += along;
                }
            }
        }
        let Some(score) = score(&grams, &rest, &own, n, &vec![0.0; n + 1]) else { return Replicated::default() };
        let size = DVector::from_iterator(own.len(), sizes.iter().map(|(_, size)| *size));
        let (mut alone, mut held, mut all): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for block in &score.blocks {
            // Along the fitted direction: what this stretch alone makes of its size, in standard deviations.
            let (left, right) = block;
            let information = (size.transpose() * left * &size)[(0, 0)].max(1e-12);
            let agrees = size.dot(&right.column(0)) / information.sqrt();
            all += information;
            if agrees > 2.0 {
                (alone, held) = (alone + 1.0, held + information);
            } else if agrees < -2.0 {
                (alone, held) = (alone - 1.0, held - information);
            }
        }
        let covariance = Grams::pick(&self.covariance, &own, &own);
        let sure = inverse(&covariance, &vec![0.0; own.len()]).map_or(0.0, |c| (size.transpose() * c * &size)[(0, 0)]);
        let count = alone.max(score.evidence / own.len() as f64);
        Replicated { count, alone, held: held / all, sure: sure.max(0.0).sqrt() }
    }

    /// Change of the prediction that the effect makes, by channel, beside what the other numbers could take over, in physical units; and
    /// the numbers without it.
    fn without(&self, card: &Card) -> (Vec<f64>, ChannelValues) {
        let own = self.places(card);
        let n = self.point().free.len();
        let rest: Vec<usize> = (0..n).filter(|i| !own.contains(i)).collect();
        let mut plain = self.point().x.clone();
        span(card).for_each(|k| plain[k] = 0.0);
        let mut taken_over = plain.clone();
        let prior: Vec<f64> =
            rest.iter().map(|&i| self.problem.model.numbers[self.point().free[i]].trust.powi(-2)).collect();
        if let Some(inner) = inverse(&Grams::pick(&self.grams.sum, &rest, &rest), &prior).filter(|_| !own.is_empty()) {
            let absorbed = inner * Grams::pick(&self.grams.sum, &rest, &own);
            for (a, &i) in rest.iter().enumerate() {
                let k = self.point().free[i];
                let number = &self.problem.model.numbers[k];
                let taken: f64 =
                    own.iter().enumerate().map(|(b, &j)| absorbed[(a, b)] * self.point().x[self.point().free[j]]).sum();
                taken_over[k] = (taken_over[k] + taken).clamp(number.low, number.high);
            }
        }
        // A large effect is not linear: where what the others take over by its slope makes it worse, they are left as they are.
        let judged = |x: Vec<f64>| {
            let state = self.problem.predict(&x);
            let residual = self.problem.residuals(&state);
            let off = |c: usize| {
                let sd = self.selection.whitener.sd(c).max(1e-12);
                residual[c].iter().map(|r| (r / sd).powi(2)).sum::<f64>()
            };
            ((0..CHANNELS).map(off).sum::<f64>(), x, state)
        };
        let (_, x, state) =
            [plain, taken_over].map(judged).into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("two");
        let (with, without) = (self.problem.pick(&self.point().state), self.problem.pick(&state));
        let change = std::array::from_fn(|c| with[c].iter().zip(&without[c]).map(|(a, b)| a - b).collect());
        (x, change)
    }

    /// Judges one added effect.
    pub fn judge(&self, added: &Added) -> Judged {
        let card = added.card;
        let (x, change) = self.without(card);
        let residual = &self.point().residual;
        let power = |v: &[f64]| mean(&v.iter().map(|x| x * x).collect::<Vec<_>>());
        let mut explained = BTreeMap::new();
        let mut most = (0.0, "");
        for c in 0..CHANNELS {
            if residual[c].is_empty() || change[c].is_empty() {
                continue;
            }
            let before: Vec<f64> = residual[c].iter().zip(&change[c]).map(|(r, d)| r + d).collect();
            let share = 1.0 - power(&residual[c]) / power(&before).max(1e-300);
            // What other channels gain is the base's, which is free to serve them.
            if !card.channels.contains(&kind(c)) {
                continue;
            }
            if share > 1e-3 {
                explained.insert(NAMES[c].0, share);
            }
            if share > most.0 || most.1.is_empty() {
                most = (share, NAMES[c].0);
            }
        }
        let parameters = self.parameters(card);
        let replicated = self.stretches(card);
        let stretches = replicated.count;
        let material = is_material(card, &self.point().x);
        let evident = replicated.evident();
        let status = if !evident {
            Status::Suspected
        } else if added.ties.is_empty() {
            Status::Named
        } else {
            Status::NamedSet
        };
        let why = (!evident).then(|| {
            if stretches < REPLICATED {
                format!("only {stretches:.0} stretches of flight agree")
            } else {
                "its size is not sure enough".into()
            }
        });
        let (manoeuvre, kinds) = card.manoeuvre;
        let finding = Finding {
            effect: card.id,
            name: card.name,
            status,
            members: std::iter::once(card.id).chain(added.ties.iter().map(|c| c.id)).collect(),
            sentence: card.sentence,
            channel: most.1,
            parameters,
            stretches,
            explained,
            gain: BTreeMap::new(),
            impact: self.impact(card, &x, &change),
            rivals: card.rivals.to_vec(),
            manoeuvre,
            kinds: kinds.to_vec(),
            why,
        };
        let change = x.iter().zip(&self.point().x).map(|(without, with)| without - with).collect();
        Judged { finding, material, bounded: is_bounded(self.problem, card, &self.point().x), change }
    }

    /// The effect's parameters as people read them, with intervals.
    fn parameters(&self, card: &Card) -> BTreeMap<String, Value> {
        let at = span(card);
        let x = &self.point().x;
        let places: Vec<usize> = self.places(card);
        let tau_places: Vec<usize> =
            [TAU.start, TAU.end - 1].iter().filter_map(|k| self.point().free.iter().position(|f| f == k)).collect();
        let values: Vec<f64> = at.clone().map(|k| x[k]).collect();
        let shown = |k: &[f64], tau: [f64; 2]| -> Vec<(String, f64, String)> {
            match card.shown {
                Some(shown) => shown(k, tau).into_iter().map(|(n, v, u)| (n.to_string(), v, u.to_string())).collect(),
                None => {
                    card.parameters.iter().zip(k).map(|(p, v)| (p.name.to_string(), *v, p.unit.to_string())).collect()
                }
            }
        };
        let tau = [x[TAU.start], x[TAU.end - 1]];
        let here = shown(&values, tau);
        // By how much each shown value changes with the fitted ones (delta method).
        let mut out = BTreeMap::new();
        for (i, (name, value, unit)) in here.iter().enumerate() {
            let mut slopes: Vec<(usize, f64)> = Vec::new();
            for (j, &place) in places.iter().enumerate() {
                let step = 1e-4 * card.parameters[j].typical[0];
                let mut moved = values.clone();
                moved[j] += step;
                slopes.push((place, (shown(&moved, tau)[i].1 - value) / step));
            }
            for (j, &place) in tau_places.iter().enumerate() {
                let mut moved = tau;
                moved[j] += 1e-6;
                slopes.push((place, (shown(&values, moved)[i].1 - value) / 1e-6));
            }
            let variance: f64 = slopes
                .iter()
                .flat_map(|a| slopes.iter().map(move |b| (a, b)))
                .map(|(a, b)| a.1 * b.1 * self.covariance[(a.0, b.0)])
                .sum();
            let half = NORMAL_95 * variance.max(0.0).sqrt();
            out.insert(
                name.clone(),
                Value { value: *value, low: value - half, high: value + half, unit: unit.clone() },
            );
        }
        out
    }

    /// How far apart simulations with and without the effect are after a second, m/s; for sensors, what the error integrates to.
    fn impact(&self, card: &Card, without: &[f64], change: &ChannelValues) -> f64 {
        let rms = |c: usize| mean(&change[c].iter().map(|x| x * x).collect::<Vec<_>>()).sqrt();
        let sensors: f64 = (0..3)
            .map(|k| rms(k) * 0.5 * GRAVITY_M_S2)
            .chain((3..6).map(rms))
            .chain((6..9).map(|c| rms(c) * 4.0 * 0.5 * GRAVITY_M_S2))
            .chain((9..12).map(|c| rms(c) * 4.0))
            .fold(0.0, f64::max);
        if matches!(card.kind, EffectKind::Sensor | EffectKind::Random) {
            return sensors;
        }
        let model = &self.problem.model;
        let state = self.problem.predict(without);
        let with = &self.point().state;
        let distances = self
            .problem
            .records
            .iter()
            .enumerate()
            .map(|(f, record)| horizon::apart(model, record, (&with[f], &self.point().x), (&state[f], without)));
        let apart = distances.fold(0.0, f64::max);
        if apart > 0.0 { apart } else { sensors }
    }
}
