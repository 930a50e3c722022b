//! What the effects are worth on flight that was not used for fitting: the last flight where there are several, else
//! the last 30 % of the time.

pub mod flexible;

use crate::base::stats::mean;
use crate::insight::criteria::flown::{HELD_OUT_ROWS, WORTH_GAINING};
use crate::insight::diagnose::fitting::fit::{self, FitPoint};
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::judgement::diagnosis::Ahead;
use crate::insight::diagnose::judgement::finding::Gain;
use crate::insight::diagnose::prediction::channels::{CHANNELS, NAMES};
use crate::insight::diagnose::prediction::horizon;
use crate::insight::diagnose::prediction::numbers::{BEGIN, ModelNumber};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::prepare::data::TRAIN_SHARE;
use std::collections::BTreeMap;

/// Base and extended model, fitted on one part of the flight and judged on the other.
pub struct HeldOut {
    pub channels: BTreeMap<&'static str, Gain>,
    pub horizons: Vec<Ahead>,
    /// Share of the achievable fall of the whitened squares; none where there is nothing to gain.
    pub captured: Option<f64>,
    extended: FitPoint,
    out: Vec<bool>,
}

impl HeldOut {
    /// What one effect is worth beside the others: the extended model against itself without that effect, whose absence
    /// moves the numbers by `change`. An effect that is only suspected is not in the extended model: there it is added.
    pub fn of_one(&self, problem: &Problem, change: &[f64], held: bool) -> BTreeMap<&'static str, Gain> {
        let sign = if held { 1.0 } else { -1.0 };
        let moved = |((x, by), n): ((&f64, &f64), &ModelNumber)| (x + sign * by).clamp(n.low, n.high);
        let x: Vec<f64> = self.extended.x.iter().zip(change).zip(&problem.model.numbers).map(moved).collect();
        let state = problem.predict(&x);
        let residual = problem.residuals(&state);
        let other = FitPoint { x, state, residual, ..FitPoint::default() };
        let [without, with] = if held { [&other, &self.extended] } else { [&self.extended, &other] };
        let mut all = channels(problem, without, with, &self.out);
        all.retain(|_, gain| gain.before.is_finite() && gain.after.is_finite());
        all
    }
}

/// Whether each stretch of time is held out.
fn held_out(problem: &Problem) -> Vec<bool> {
    let mut out = vec![false; problem.blocks];
    let last = problem.records.len() - 1;
    let blocks: Vec<u32> = problem.records[last].block.clone();
    let (Some(&first), Some(&end)) = (blocks.first(), blocks.last()) else { return out };
    let from = if last > 0 { first } else { first + ((end - first) as f64 * TRAIN_SHARE) as u32 };
    (from..=end).for_each(|b| out[b as usize] = true);
    out
}

/// Fits on the one part, predicts the other: the base, and what is `kept` of the `selection`. What could be gained at
/// most is what a flexible regression gains beyond that.
pub fn measure(problem: &Problem, selection: &Selection, kept: &Selection) -> HeldOut {
    let out = held_out(problem);
    let train = selection.whitener.without(&problem.rows, &out);
    let test = selection.whitener.without(&problem.rows, &out.iter().map(|o| !o).collect::<Vec<_>>());
    let base = fit::fit(problem, &train, &selection.base.x, &selection.base.free);
    let extended =
        if kept.added.is_empty() { base.clone() } else { fit::fit(problem, &train, &kept.point.x, &kept.point.free) };
    // A flight that was held out as a whole has not told yet with which voltage it began.
    let last = problem.records.len() - 1;
    let (base, extended) = if last > 0 {
        let begin = [BEGIN + last];
        let settled = |p: FitPoint| {
            let free = p.free.clone();
            FitPoint { free, ..fit::fit(problem, &test, &p.x, &begin) }
        };
        (settled(base), settled(extended))
    } else {
        (base, extended)
    };
    let squares = |p: &FitPoint| fit::costs(problem, &test.apply(&p.residual, &problem.rows)).iter().sum::<f64>();
    let (before, after) = (squares(&base), squares(&extended));
    // What a regression on the signals learns from the one part, and tells on the other.
    let corrected = flexible::corrected(problem, &extended, &out);
    let floor = fit::costs(problem, &test.apply(&corrected, &problem.rows)).iter().sum::<f64>().min(after);
    let captured = (before > WORTH_GAINING.get() * floor).then(|| (before - after) / (before - floor).max(1e-9));
    HeldOut {
        channels: channels(problem, &base, &extended, &out),
        horizons: horizons(problem, &base, &extended, &out),
        captured: captured.map(|c| c.min(1.0)),
        extended,
        out,
    }
}

/// What was gained of what could be gained at most, in words.
pub fn words(captured: f64) -> String {
    if captured >= 1.0 {
        // No more than that: it may have learned nothing that holds there.
        return "a regression that knows nothing of vehicles gains nothing beyond that on that flight".into();
    }
    let share = 100.0 * captured.max(0.0);
    format!("{share:.0} % of what could be gained was, by a regression that knows nothing of vehicles, on that flight")
}

fn channels(problem: &Problem, base: &FitPoint, extended: &FitPoint, out: &[bool]) -> BTreeMap<&'static str, Gain> {
    let mut all = BTreeMap::new();
    for c in 0..CHANNELS {
        let rows: Vec<usize> = (0..problem.rows[c].len()).filter(|&i| out[problem.rows[c][i].block as usize]).collect();
        if rows.len() < HELD_OUT_ROWS.count() || base.residual[c].is_empty() {
            continue;
        }
        let rms = |p: &FitPoint| mean(&rows.iter().map(|&i| p.residual[c][i].powi(2)).collect::<Vec<_>>()).sqrt();
        let measured: Vec<f64> = rows.iter().map(|&i| problem.measured[c][i]).collect();
        let middle = mean(&measured);
        let variance = mean(&measured.iter().map(|m| (m - middle).powi(2)).collect::<Vec<_>>());
        let (before, after) = (rms(base), rms(extended));
        let r2 = |e: f64| 1.0 - e * e / variance.max(1e-300);
        let (name, unit) = NAMES[c];
        all.insert(name, Gain { before, after, r2_before: r2(before), r2_after: r2(after), unit });
    }
    all
}

fn horizons(problem: &Problem, base: &FitPoint, extended: &FitPoint, out: &[bool]) -> Vec<Ahead> {
    let f = problem.records.len() - 1;
    let record = &problem.records[f];
    let wanted = |i: usize| out[record.block[i] as usize];
    let at = |p: &FitPoint| horizon::errors(&problem.model, record, &p.state[f], &p.x, &wanted);
    let pairs = at(base).into_iter().zip(at(extended));
    pairs.filter(|(b, _)| b.starts > 0).map(|(before, after)| Ahead { before, after }).collect()
}

impl Whitener {
    /// The same, deaf to the stretches of time that are `out`.
    pub fn without(
        &self,
        rows: &[Vec<crate::insight::diagnose::prediction::problem::ResidualRow>; CHANNELS],
        out: &[bool],
    ) -> Self {
        let mut copy = self.clone();
        for (c, weights) in copy.weights_mut().iter_mut().enumerate() {
            for (row, weight) in rows[c].iter().zip(weights.iter_mut()) {
                if out[row.block as usize] {
                    *weight = 0.0;
                }
            }
        }
        copy
    }
}
