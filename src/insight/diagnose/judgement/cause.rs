//! An effect that looks like nothing but a move of thrust and drag against the base vehicle: the compact model takes it
//! up without trace, and only the base tells.

use super::finding::{Finding, Status, Value};
use crate::base::stats::{NORMAL_95, mean};
use crate::insight::criteria::drifted::{CAUSE_ACCOUNTS, CAUSE_TIE, CAUSE_TIE_SHARE, COMPENSATED, MOVED_DEVIATIONS};
use crate::insight::criteria::material::MATERIAL_SIZE;
use crate::insight::diagnose::fitting::fit::covariance;
use crate::insight::diagnose::prediction::channels::FORCE;
use crate::insight::diagnose::prediction::numbers::{THRUST, is_force, span};
use crate::insight::diagnose::prediction::problem::ChannelValues;
use crate::insight::diagnose::selection::caused::ForceCause;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use crate::model::effects::{self, Card, CompactNumber};
use nalgebra::{DMatrix, DVector};
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
    if best.share < CAUSE_ACCOUNTS.get() || moved.in_proportion() > best.share {
        return None;
    }
    let close = |other: &&Account| 1.0 - other.share < CAUSE_TIE.get() * (1.0 - best.share) + CAUSE_TIE_SHARE.get();
    let near: Vec<&'static str> = found.iter().skip(1).filter(close).map(|other| other.way.card.id).collect();
    finding(fitted, best, near)
}

/// By how much of the move an effect accounts for, and with which size.
struct Account {
    way: ForceCause,
    share: f64,
    size: f64,
}

/// The move of the numbers of thrust and drag, and what it does to the residuals.
struct Moved<'a> {
    fitted: &'a FittedSelection<'a>,
    /// Their places among the fitted numbers.
    main: Vec<usize>,
    by: DVector<f64>,
    /// Whitened squares of a move of theirs, where all other numbers make up for it.
    metric: DMatrix<f64>,
    energy: f64,
    /// Inverse of the information on all fitted numbers.
    everything: DMatrix<f64>,
}

impl<'a> Moved<'a> {
    fn new(fitted: &'a FittedSelection, sum: &DMatrix<f64>) -> Option<Self> {
        let (numbers, base) = (&fitted.problem.model.numbers, &fitted.problem.model.base);
        let (free, x) = (&fitted.selection.point.free, &fitted.selection.point.x);
        let own: Vec<usize> = (0..free.len()).collect();
        let (main, rest): (Vec<usize>, Vec<usize>) = own.iter().partition(|i| is_force(free[**i]));
        let prior = |which: &[usize]| -> Vec<f64> { which.iter().map(|&i| numbers[free[i]].trust.powi(-2)).collect() };
        let inner = inverse(&Grams::pick(sum, &rest, &rest), &prior(&rest))?;
        let cross = Grams::pick(sum, &rest, &main);
        let metric = Grams::pick(sum, &main, &main) - cross.transpose() * &inner * &cross;
        let by = DVector::from_iterator(main.len(), main.iter().map(|&i| x[free[i]] - base[free[i]]));
        let energy = (by.transpose() * &metric * &by)[(0, 0)];
        let everything = inverse(&Grams::pick(sum, &own, &own), &prior(&own))?;
        Some(Self { fitted, main, by, metric, energy, everything })
    }

    /// What the effect of column `c` beside the fitted numbers accounts for; none where its size is not sure or nobody
    /// would notice.
    fn account(&self, way: ForceCause, sum: &DMatrix<f64>, c: usize) -> Option<Account> {
        let n = self.everything.nrows();
        let absorbed = &self.everything * Grams::pick(sum, &(0..n).collect::<Vec<_>>(), &[n + c]);
        let direction = DVector::from_iterator(self.main.len(), self.main.iter().map(|&i| absorbed[(i, 0)]));
        let weight = &self.metric * &direction;
        let norm = (direction.transpose() * &weight)[(0, 0)].max(1e-300);
        let size = (weight.transpose() * &self.by)[(0, 0)] / norm;
        let share = size * size * norm / self.energy.max(1e-300);
        let covariance = Grams::pick(&self.fitted.covariance, &self.main, &self.main);
        let sd = ((weight.transpose() * covariance * &weight)[(0, 0)]).max(0.0).sqrt() / norm;
        let p = &way.card.parameters[0];
        let least = if way.about_full { COMPENSATED.get() } else { MATERIAL_SIZE.get() * p.typical[0] };
        // Of the other sign it would be no effect: no thrust comes back with time.
        let possible = size >= p.low;
        let sure = possible && size.abs() > least && size.abs() > MOVED_DEVIATIONS.get() * sd;
        sure.then_some(Account { way, share, size })
    }

    /// The share that a change of thrust alone, in proportion, accounts for: that is no effect.
    fn in_proportion(&self) -> f64 {
        let free = &self.fitted.selection.point.free;
        let base = |k: usize| if THRUST.contains(&k) { self.fitted.problem.model.base[k] } else { 0.0 };
        let scale = DVector::from_iterator(self.main.len(), self.main.iter().map(|&i| base(free[i])));
        let weight = &self.metric * &scale;
        let norm = (scale.transpose() * &weight)[(0, 0)].max(1e-300);
        ((weight.transpose() * &self.by)[(0, 0)]).powi(2) / norm / self.energy.max(1e-300)
    }
}

/// The finding of `best`, which `near` ones come close to.
fn finding(fitted: &FittedSelection, best: &Account, near: Vec<&'static str>) -> Option<Finding> {
    let card = best.way.card;
    let (size, sd) = instead(fitted, card, best.size)?;
    let p = &card.parameters[0];
    let half = NORMAL_95 * sd;
    let value = Value { value: size, low: size - half, high: size + half, unit: p.unit.into() };
    Some(Finding {
        status: if near.is_empty() { Status::Named } else { Status::NamedSet },
        members: std::iter::once(card.id).chain(near).collect(),
        channel: "specific force z",
        parameters: BTreeMap::from([(p.name.to_string(), value)]),
        stretches: (size / sd.max(1e-300)).powi(2).min(fitted.problem.blocks as f64),
        explained: BTreeMap::from([(MOVES, best.share)]),
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
fn instead(fitted: &FittedSelection, card: &'static Card, size: f64) -> Option<(f64, f64)> {
    let caused = fitted.selection.with_cause(fitted.problem, card, size);
    let last = caused.point.free.len() - 1;
    let sd = covariance(fitted.problem, &caused.whitener, &caused.point)?[(last, last)].max(0.0).sqrt();
    Some((caused.point.x[span(card).start], sd))
}
