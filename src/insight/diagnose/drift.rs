//! Numbers of the compact model that moved, and effects that look like nothing but such a move.

use super::finding::{Drift, Finding, Status, Value};
use super::fit::{covariance, fit};
use super::judge::Judge;
use super::numbers::{DISCHARGE, DRAG, MAX_RATE, TAU, THRUST, span};
use super::problem::ChannelValues;
use crate::base::stats::NORMAL_95;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use crate::model::effects::{self, Card};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// Relative change below which nobody cares: time constants, rates, thrust, drag, discharge.
const MATERIAL: [f64; 5] = [0.05, 0.015, 0.02, 0.1, 0.2];
/// Standard deviations that a change has to be.
const SURE: f64 = 4.0;
/// Share of the whole move that an effect has to account for to be named as its cause.
const ACCOUNTS: f64 = 0.9;

/// What such an effect explains.
pub const MOVES: &str = "moves of thrust and drag against the base vehicle";

/// Effects that the compact model can take up without trace, as a change of its own numbers.
const ABSORBED: [&str; 4] = ["mass_or_density", "voltage_compensation", "throttle_offset", "thrust_fade"];

/// Numbers that differ from the base vehicle's, and a cause if one explains all of thrust's and drag's moves.
pub fn find(judge: &Judge) -> (Vec<Drift>, Option<Finding>) {
    let point = &judge.selection.point;
    let model = &judge.problem.model;
    let mut out = Vec::new();
    let place = |k: usize| point.free.iter().position(|f| *f == k);
    let mut add = |name: &str, unit, base: f64, value: f64, sd: f64, material: f64, scale: f64| {
        let change = value - base;
        if change.abs() > SURE * sd && change.abs() > material * base.abs() {
            let half = NORMAL_95 * sd * scale;
            let value = value * scale;
            out.push(Drift {
                parameter: name.into(),
                base: base * scale,
                value,
                low: value - half,
                high: value + half,
                unit,
            });
        }
    };
    for (range, material, scale, unit) in [
        (TAU, MATERIAL[0], 1e3, "ms"),
        (MAX_RATE, MATERIAL[1], 1f64.to_degrees(), "deg/s"),
        (DRAG, MATERIAL[3], 1.0, "1/m"),
        (DISCHARGE..DISCHARGE + 1, MATERIAL[4], 60.0, "V/min"),
    ] {
        for k in range {
            let Some(i) = place(k) else { continue };
            let sd = judge.covariance[(i, i)].max(0.0).sqrt();
            add(&model.numbers[k].name, unit, model.base[k], point.x[k], sd, material, scale);
        }
    }
    let v = model.vehicle().battery;
    let volts = 0.5 * (v.full_v + v.empty_v);
    let u = 0.2;
    let gradient = [1.0, u, u * u, u * u * u, volts, u * volts];
    let at = |x: &[f64]| (0..6).map(|k| gradient[k] * x[THRUST.start + k]).sum::<f64>();
    let mut variance = 0.0;
    for a in 0..6 {
        for b in 0..6 {
            if let (Some(i), Some(j)) = (place(THRUST.start + a), place(THRUST.start + b)) {
                variance += gradient[a] * gradient[b] * judge.covariance[(i, j)];
            }
        }
    }
    let (base, now) = (at(&model.base), at(&point.x));
    add("thrust over mass at 60 % throttle", "m/s2", base, now, variance.max(0.0).sqrt(), MATERIAL[2], 1.0);
    let moved = !out.is_empty() || voltage_moved(judge);
    let cause = if moved { cause(judge) } else { None };
    (out, cause)
}

fn voltage_moved(judge: &Judge) -> bool {
    let point = &judge.selection.point;
    let k = THRUST.start + 5;
    let Some(i) = point.free.iter().position(|f| *f == k) else { return false };
    let change = (point.x[k] - judge.problem.model.base[k]).abs();
    change > SURE * judge.covariance[(i, i)].max(0.0).sqrt() && change > 0.1 * judge.problem.model.base[k].abs()
}

/// The effect whose absorption accounts for the move of thrust and drag.
fn cause(judge: &Judge) -> Option<Finding> {
    let problem = judge.problem;
    let point = &judge.selection.point;
    let residual = judge.selection.whitener.apply(&point.residual, &problem.rows);
    let unnamed = |card: &&Card| !point.free.contains(&span(card).start);
    let cards: Vec<&'static Card> = ABSORBED.iter().filter_map(|id| effects::card(id)).filter(unnamed).collect();
    let n = point.free.len();
    let columns: Vec<ChannelValues> = cards
        .iter()
        .map(|card| {
            let k = span(card).start;
            let size = card.parameters[0].typical[0];
            judge
                .selection
                .whitener
                .apply(&problem.secant(&point.state, &point.x, &[(k, size)], 1.0 / size), &problem.rows)
        })
        .collect();
    let all: Vec<&ChannelValues> = point.white.iter().chain(&columns).chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let of_interest = |k: usize| THRUST.contains(&k) || DRAG.contains(&k);
    let main: Vec<usize> = (0..n).filter(|&i| of_interest(point.free[i])).collect();
    let rest: Vec<usize> = (0..n).filter(|i| !main.contains(i)).collect();
    let prior = |which: &[usize]| -> Vec<f64> {
        which.iter().map(|&i| problem.model.numbers[point.free[i]].trust.powi(-2)).collect()
    };
    let inner = inverse(&Grams::pick(&grams.sum, &rest, &rest), &prior(&rest))?;
    let cross = Grams::pick(&grams.sum, &rest, &main);
    let metric: DMatrix<f64> = Grams::pick(&grams.sum, &main, &main) - cross.transpose() * &inner * &cross;
    let moved = DVector::from_iterator(
        main.len(),
        main.iter().map(|&i| point.x[point.free[i]] - problem.model.base[point.free[i]]),
    );
    let energy = (moved.transpose() * &metric * &moved)[(0, 0)];
    let own: Vec<usize> = (0..n).collect();
    let everything = inverse(&Grams::pick(&grams.sum, &own, &own), &prior(&own))?;
    let mut found: Vec<(f64, usize, f64, f64)> = Vec::new();
    for (c, card) in cards.iter().enumerate() {
        if columns[c].iter().all(Vec::is_empty) {
            continue;
        }
        let absorbed = &everything * Grams::pick(&grams.sum, &own, &[n + c]);
        let d = DVector::from_iterator(main.len(), main.iter().map(|&i| absorbed[(i, 0)]));
        let weight = &metric * &d;
        let norm = (d.transpose() * &weight)[(0, 0)].max(1e-300);
        let size = (weight.transpose() * &moved)[(0, 0)] / norm;
        let accounts = size * size * norm / energy.max(1e-300);
        let covariance = Grams::pick(&judge.covariance, &main, &main);
        let sd = ((weight.transpose() * covariance * &weight)[(0, 0)]).max(0.0).sqrt() / norm;
        if size.abs() > 0.5 * card.parameters[0].typical[0] && size.abs() > SURE * sd {
            found.push((accounts, c, size, sd));
        }
    }
    // A change of thrust alone, in proportion, is no effect.
    let scale = DVector::from_iterator(
        main.len(),
        main.iter().map(|&i| {
            let k = point.free[i];
            if THRUST.contains(&k) { problem.model.base[k] } else { 0.0 }
        }),
    );
    let weight = &metric * &scale;
    let norm = (scale.transpose() * &weight)[(0, 0)].max(1e-300);
    let plain = ((weight.transpose() * &moved)[(0, 0)]).powi(2) / norm / energy.max(1e-300);
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let &(accounts, c, size, _) = found.first()?;
    if accounts < ACCOUNTS || plain > accounts {
        return None;
    }
    let card = cards[c];
    let (size, sd) = instead(judge, card, size)?;
    let near: Vec<&'static str> =
        found.iter().skip(1).filter(|f| 1.0 - f.0 < 2.0 * (1.0 - accounts) + 0.003).map(|f| cards[f.1].id).collect();
    let p = &card.parameters[0];
    let (manoeuvre, kinds) = card.manoeuvre;
    let half = NORMAL_95 * sd;
    let value = Value { value: size, low: size - half, high: size + half, unit: p.unit.into() };
    Some(Finding {
        effect: card.id,
        name: card.name,
        status: if near.is_empty() { Status::Named } else { Status::NamedSet },
        members: std::iter::once(card.id).chain(near).collect(),
        sentence: card.sentence,
        channel: "specific force z",
        parameters: BTreeMap::from([(p.name.to_string(), value)]),
        stretches: (size / sd.max(1e-300)).powi(2).min(problem.blocks as f64),
        explained: BTreeMap::from([(MOVES, accounts)]),
        gain: BTreeMap::new(),
        impact: size.abs(),
        rivals: card.rivals.to_vec(),
        manoeuvre,
        kinds: kinds.to_vec(),
        why: None,
    })
}

/// Size and standard deviation of an effect that takes the place of all moves of thrust and drag, near `size`.
fn instead(judge: &Judge, card: &Card, size: f64) -> Option<(f64, f64)> {
    let (problem, whitener) = (judge.problem, &judge.selection.whitener);
    let moves = |k: &usize| THRUST.contains(k) || DRAG.contains(k);
    let own = span(card).start;
    let mut x = judge.selection.point.x.clone();
    (0..x.len()).filter(moves).for_each(|k| x[k] = problem.model.base[k]);
    x[own] = size;
    let kept = judge.selection.point.free.iter().copied().filter(|k| !moves(k));
    let free: Vec<usize> = kept.chain([own]).collect();
    let point = fit(problem, whitener, &x, &free);
    let last = free.len() - 1;
    let sd = covariance(problem, whitener, &point)?[(last, last)].max(0.0).sqrt();
    Some((point.x[own], sd))
}
