//! An effect that looks like nothing but a move of thrust and drag against the base vehicle: the compact model takes it
//! up without trace, and only the base tells.

mod moved;

use super::finding::{Finding, Status, Value};
use super::pays::pays;
use crate::base::stats::mean;
use crate::insight::criteria::drifted::{CAUSE_TIE, CAUSE_TIE_SHARE};
use crate::insight::criteria::unseen::PAYS_DEVIATIONS;
use crate::insight::diagnose::fitting::fit::covariance;
use crate::insight::diagnose::fitting::unseen::even_parts;
use crate::insight::diagnose::prediction::channels::FORCE;
use crate::insight::diagnose::prediction::numbers::{THRUST, span};
use crate::insight::diagnose::prediction::problem::ChannelValues;
use crate::insight::diagnose::selection::caused::ForceCause;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::model::effects::{self, Card, CompactNumber};
use moved::{Account, Moved, is_sure};
use std::collections::{BTreeMap, BTreeSet};

/// What such an effect explains.
pub const MOVES: &str = "moves of thrust and drag against the base vehicle";

/// The effect whose absorption accounts for the move of thrust and drag.
pub fn find(fitted: &FittedSelection) -> Option<Finding> {
    let problem = fitted.problem;
    let point = &fitted.selection.point;
    let absorbed = |card: &&Card| card.absorbed_by.contains(&CompactNumber::Thrust);
    let unnamed = |card: &&Card| !point.free.contains(&span(card).start);
    let cards: Vec<&'static Card> = effects::cards().filter(absorbed).filter(unnamed).collect();
    let ways: Vec<ForceCause> = cards.into_iter().flat_map(ForceCause::of).collect();
    let whitener = &fitted.selection.whitener;
    let column = |way: &ForceCause| {
        let size = way.card.parameters[0].typical[0];
        let mut column = change(fitted, *way, size);
        column.iter_mut().flatten().for_each(|d| *d /= size);
        whitener.apply(&column, &problem.rows)
    };
    let columns: Vec<ChannelValues> = ways.iter().map(column).collect();
    let all: Vec<&ChannelValues> = point.white.iter().chain(&columns).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let moved = Moved::new(fitted, &grams.sum)?;
    let visible = (0..ways.len()).filter(|&c| !columns[c].iter().all(Vec::is_empty));
    let mut found: Vec<Account> = visible.filter_map(|c| moved.account(ways[c], &grams.sum, c)).collect();
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    let mut seen = BTreeSet::new();
    found.retain(|account| seen.insert(account.way.card.id));
    let best = found.first()?;
    if moved.in_proportion(best.limits) > best.share || !is_needed(fitted) {
        return None;
    }
    let close = |other: &&Account| 1.0 - other.share < CAUSE_TIE.get() * (1.0 - best.share) + CAUSE_TIE_SHARE.get();
    let near: Vec<&'static str> = found.iter().skip(1).filter(close).map(|other| other.way.card.id).collect();
    finding(fitted, best, near)
}

/// Whether the thrust's move pays on unseen flight: else the base's thrust does as well, and nothing has moved it.
fn is_needed(fitted: &FittedSelection) -> bool {
    let free = &fitted.selection.point.free;
    let thrust = (0..free.len()).filter(|&i| THRUST.contains(&free[i])).collect();
    pays(fitted, &even_parts(fitted.problem), &[thrust])[0].surely() > PAYS_DEVIATIONS.get()
}

/// The finding of `best`, which `near` ones come close to.
fn finding(fitted: &FittedSelection, best: &Account, near: Vec<&'static str>) -> Option<Finding> {
    let card = best.way.card;
    let (size, sd) = instead(fitted, best.way, best.size)?;
    let sd = sd.max(best.sd);
    // What it was by the moves may be something else in the flight.
    if !is_sure(best.way, size, sd) {
        return None;
    }
    let p = &card.parameters[0];
    Some(Finding {
        status: if near.is_empty() { Status::Named } else { Status::NamedSet },
        members: std::iter::once(card.id).chain(near).collect(),
        channel: "specific force z",
        parameters: BTreeMap::from([(p.name.to_string(), Value::measured(size, sd, p.unit))]),
        stretches: (size / sd.max(1e-300)).powi(2).min(fitted.problem.blocks as f64),
        explained: BTreeMap::from([(MOVES, best.share)]),
        cause: Some(best.way),
        impact: pushes(fitted, best.way, size),
        ..Finding::of(card)
    })
}

/// By how much an effect of that size changes the vertical specific force, root mean square: m/s after a second of it.
fn pushes(fitted: &FittedSelection, way: ForceCause, size: f64) -> f64 {
    mean(&change(fitted, way, size)[FORCE + 2].iter().map(|d| d * d).collect::<Vec<_>>()).sqrt()
}

/// Change of the prediction by an effect of that size in the base vehicle: what fitted numbers have taken up of it
/// leaves nothing to change in them.
fn change(fitted: &FittedSelection, way: ForceCause, size: f64) -> ChannelValues {
    let problem = fitted.problem;
    let [without, with] = [0.0, size].map(|size| way.numbers(&problem.model, &fitted.point().x, size));
    let to: Vec<(usize, f64)> = (0..with.len()).filter(|&k| with[k] != without[k]).map(|k| (k, with[k])).collect();
    problem.secant(&problem.predict(&without), &without, &to, 1.0)
}

/// Size and standard deviation of an effect that takes the place of all moves of thrust and drag, near `size`.
fn instead(fitted: &FittedSelection, way: ForceCause, size: f64) -> Option<(f64, f64)> {
    let caused = fitted.selection.with_cause(fitted.problem, way, size);
    let last = caused.point.free.len() - 1;
    let sd = covariance(fitted.problem, &caused.whitener, &caused.point)?[(last, last)].max(0.0).sqrt();
    Some((caused.point.x[span(way.card).start], sd))
}
