//! From the fit of two sets of flights to what changed: evident, lasting, of a size that matters, and worth it on
//! unseen flight.

use super::change::Change;
use super::columns::later;
use super::sizes;
use super::suspect::{FoundDifference, Suspect};
use crate::base::stats::chi_squared_chance;
use crate::insight::criteria::changed::{
    BETWEEN_DEVIATIONS, CHANGED_BIAS, CHANGED_CHANCE, CHANGED_IMPACT, CHANGED_SENSOR, KNOWN_DEVIATIONS, KNOWN_SHARE,
    LASTING_KNOWN, LASTING_SHARE,
};
use crate::insight::criteria::material::{LEAST_SENSOR_IMPACT, MATERIAL_SIZE};
use crate::insight::criteria::unseen::PAYS_DEVIATIONS;
use crate::insight::diagnose::fitting::score::{ScoreTest, score};
use crate::insight::diagnose::fitting::unseen::thirds;
use crate::insight::diagnose::judgement::finding::Status;
use crate::insight::diagnose::judgement::impact::integrated;
use crate::insight::diagnose::judgement::pays::pays;
use crate::insight::diagnose::prediction::horizon;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use crate::model::effects::{EffectKind, Role};

/// Judges the differences that were `found`, each beside the others.
pub fn all(fitted: &FittedSelection, suspects: &[Suspect], found: &[FoundDifference]) -> Vec<Change> {
    let evident = |f: &FoundDifference| evident(fitted, places(fitted, &suspects[f.suspect]));
    let places: Vec<Vec<usize>> = found.iter().map(evident).collect();
    let pays = pays(fitted, &thirds(fitted.problem), &places);
    found.iter().zip(pays).map(|(found, pays)| judge(fitted, suspects, found, pays.limited)).collect()
}

/// Judges a difference, of so many suspects; `pays` is by how sure it lowers the squares of unseen thirds of all
/// flights.
fn judge(fitted: &FittedSelection, suspects: &[Suspect], found: &FoundDifference, pays: f64) -> Change {
    let suspect = &suspects[found.suspect];
    let own = places(fitted, suspect);
    let sizes = sizes::of(fitted, suspect);
    let impact = impact(fitted, suspect);
    let (squares, chance) = chance(fitted, &own);
    let least = match suspect.card.map(|card| card.kind) {
        Some(EffectKind::Battery) | None => 0.0,
        Some(EffectKind::Sensor) => LEAST_SENSOR_IMPACT.get(),
        Some(_) => CHANGED_IMPACT.get(),
    };
    let why = if chance * suspects.len() as f64 > CHANGED_CHANCE.get() {
        Some("the stretches of flight do not agree well enough".to_string())
    } else if !matters(fitted, suspect) || impact < least {
        Some("too small for anybody to notice".into())
    } else if suspect.is_bounded(fitted.problem, &fitted.point().x) {
        Some("its size is at an end of its range: it stands in for something else".into())
    } else if pays < PAYS_DEVIATIONS.get() {
        Some("on flight that was not used for fitting it does not pay".into())
    } else {
        unlasting(fitted, &own)
    };
    let status = match (&why, found.ties.is_empty()) {
        (Some(_), _) => Status::Suspected,
        (None, true) => Status::Named,
        (None, false) => Status::NamedSet,
    };
    Change {
        cause: suspect.id,
        name: suspect.name,
        status,
        members: std::iter::once(suspect.id).chain(found.ties.iter().map(|&i| suspects[i].id)).collect(),
        sentence: suspect.sentence,
        before: sizes.before,
        after: sizes.after,
        difference: sizes.difference,
        deviations: squares.sqrt(),
        impact: Some(impact),
        why,
    }
}

/// Places of the differences of a suspect among the fitted numbers.
fn places(fitted: &FittedSelection, suspect: &Suspect) -> Vec<usize> {
    let place = |k: &usize| fitted.point().free.iter().position(|f| f == k);
    suspect.own.iter().filter_map(place).collect()
}

/// Those of the differences at `own` that are known to be any. What the others are without a third of the time is
/// chance, and would hide what these explain of it. All of them, where they stand in for one another and are known
/// together alone.
fn evident(fitted: &FittedSelection, own: Vec<usize>) -> Vec<usize> {
    let known: Vec<usize> = own.iter().copied().filter(|&i| deviations(fitted, i) >= KNOWN_DEVIATIONS.get()).collect();
    let [part, whole] = [&known, &own].map(|places| chance(fitted, places).0);
    if known.is_empty() || part < KNOWN_SHARE.get() * whole { own } else { known }
}

/// Squared standard deviations of the differences at `own`, and the chance of as many.
fn chance(fitted: &FittedSelection, own: &[usize]) -> (f64, f64) {
    let covariance = Grams::pick(&fitted.covariance, own, own);
    // A number at its bound has no spread.
    if own.is_empty() || (0..own.len()).any(|i| covariance[(i, i)] <= 0.0) {
        return (0.0, 1.0);
    }
    let Some(inner) = inverse(&covariance, &vec![1e-300; own.len()]) else { return (0.0, 1.0) };
    let point = fitted.point();
    let d = nalgebra::DVector::from_iterator(own.len(), own.iter().map(|&i| point.x[point.free[i]]));
    let squares = (d.transpose() * inner * &d)[(0, 0)];
    (squares, chi_squared_chance(squares, own.len()))
}

/// Whether anybody would notice a difference of this size.
fn matters(fitted: &FittedSelection, suspect: &Suspect) -> bool {
    let x = &fitted.point().x;
    let Some(card) = suspect.card else { return sizes::share(fitted, suspect) > suspect.matters };
    let least = match (card.role, card.kind) {
        (Role::ConstantError, _) => CHANGED_BIAS.get(),
        (Role::ClockFast, _) => MATERIAL_SIZE.get(),
        (_, EffectKind::Sensor) => CHANGED_SENSOR.get(),
        _ => MATERIAL_SIZE.get(),
    };
    let share =
        |(k, (_, p)): (&usize, (usize, &crate::model::effects::EffectParameter))| (x[*k] / p.typical[0]).powi(2);
    suspect.own.iter().zip(card.sizes()).map(share).sum::<f64>().sqrt() >= least
}

/// Why a difference is not the same over the time, or between flights; none where it is.
fn unlasting(fitted: &FittedSelection, own: &[usize]) -> Option<String> {
    let problem = fitted.problem;
    let &main = own.iter().max_by(|a, b| deviations(fitted, **a).total_cmp(&deviations(fitted, **b)))?;
    let rest = fitted.rest(&[main]);
    let point = fitted.point();
    let number = |i: usize| problem.model.numbers[point.free[i]].trust.powi(-2);
    let prior: Vec<f64> = (0..point.free.len()).map(number).chain([0.0]).collect();
    let score = score(&fitted.grams, &rest, &[main], point.free.len(), &prior)?;
    let size = point.x[point.free[main]];
    for part in thirds(problem) {
        let (off, known) = moved(&score, |b| part[b]);
        if known > LASTING_KNOWN.get() && (size + off) / size < LASTING_SHARE.get() {
            return Some("not every third of the flights shows it".into());
        }
    }
    let spread = between(problem, &score, &later(problem));
    (size.abs() < BETWEEN_DEVIATIONS.get() * spread).then(|| "flights of one set differ by as much".into())
}

fn deviations(fitted: &FittedSelection, i: usize) -> f64 {
    let point = fitted.point();
    point.x[point.free[i]].abs() / fitted.covariance[(i, i)].max(1e-300).sqrt()
}

/// By how much stretches by themselves put a number elsewhere, and their share of what is known of it.
fn moved(score: &ScoreTest, wanted: impl Fn(usize) -> bool) -> (f64, f64) {
    let chosen = score.blocks.iter().enumerate().filter(|(b, _)| wanted(*b));
    let (known, pull) = chosen.fold((0.0, 0.0), |(k, u), (_, (i, own))| (k + i[(0, 0)], u + own[(0, 0)]));
    (pull / known.max(1e-300), known / score.information[0].max(1e-300))
}

/// Standard deviation of the difference by the spread of the flights within their sets; 0 where no set has several.
fn between(problem: &Problem, score: &ScoreTest, later: &[bool]) -> f64 {
    let flight = |f: usize| {
        let blocks = &problem.records[f].block;
        let range = blocks.first().map_or(0, |b| *b as usize)..=blocks.last().map_or(0, |b| *b as usize);
        let set = later[*range.start()];
        // The other set takes its part of the difference: the whole residual of a flight is what only a share explains.
        (set, moved(score, |b| range.contains(&b)).0 * moved(score, |b| later[b] == set).1)
    };
    let flights: Vec<(bool, f64)> = (0..problem.records.len()).map(flight).collect();
    let of = |set: bool| flights.iter().filter(move |(later, _)| *later == set).map(|(_, off)| *off);
    let (mut squares, mut free) = (0.0, 0);
    for set in [false, true] {
        let n = of(set).count();
        let mean = of(set).sum::<f64>() / n as f64;
        squares += of(set).map(|off| (off - mean).powi(2)).sum::<f64>();
        free += n - 1;
    }
    let each = [false, true].map(|set| 1.0 / of(set).count() as f64).iter().sum::<f64>();
    if free == 0 { 0.0 } else { (squares / free as f64 * each).sqrt() }
}

/// How far apart simulations of the later flights with and without the difference are after a second, m/s; for sensors,
/// what the error integrates to.
fn impact(fitted: &FittedSelection, suspect: &Suspect) -> f64 {
    let (problem, point) = (fitted.problem, fitted.point());
    let mut x = point.x.clone();
    suspect.own.iter().for_each(|&k| x[k] = 0.0);
    let state = problem.change(&point.state, &suspect.own, &x);
    let (with, without) = (problem.pick(&point.state), problem.pick(&state));
    let sensors = integrated(&std::array::from_fn(|c| with[c].iter().zip(&without[c]).map(|(a, b)| a - b).collect()));
    if suspect.card.is_some_and(|card| card.kind == EffectKind::Sensor) {
        return sensors;
    }
    let later = problem.contrast.iter().flat_map(|c| &c.later).enumerate().filter(|(_, later)| **later);
    let distance = |(f, _): (usize, &bool)| {
        let (a, b) = (problem.numbers(f, &point.x), problem.numbers(f, &x));
        horizon::apart(&problem.model, &problem.records[f], (&point.state[f], &a), (&state[f], &b))
    };
    let apart = later.map(distance).fold(0.0, f64::max);
    if apart > 0.0 { apart } else { sensors }
}
