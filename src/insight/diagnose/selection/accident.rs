//! A bad second costs a second: what is extreme under the final model, such as a hit, a throw or a glitch, is left out
//! and told, and the selection is made again without it.

use super::Selection;
use super::select::select;
use crate::base::stats::{median, robust_sd};
use crate::flight::spans::{self, Span};
use crate::insight::Watch;
use crate::insight::criteria::usable::{
    ACCIDENT_DEVIATIONS, ACCIDENT_MARGIN_S, ACCIDENT_POWER, ACCIDENT_SECONDS, ACCIDENT_SHARE, SHORTEST_FLIGHT_S,
};
use crate::insight::diagnose::prediction::channels::{CHANNELS, NAMES};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::quality::Quality;
use serde::Serialize;
use std::collections::BTreeMap;

/// Flight that was left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// Name of the log.
    pub log: String,
    /// From, to, s since the start of the log.
    pub span_s: Span,
    /// The channel that is furthest off.
    pub channel: &'static str,
    /// So many times as far off as in the median second.
    pub times: f64,
    /// Which flight it is of, in the order given.
    #[serde(skip)]
    flight: usize,
}

/// The flights `logs` as a problem, what explains them, and what was left out.
pub fn select_steady(
    logs: Vec<Quality>,
    problem_of: impl Fn(Vec<Quality>) -> Problem,
    watch: Watch,
) -> (Problem, Selection, Vec<LeftOut>) {
    let problem = problem_of(logs.clone());
    let selection = select(&problem, watch);
    let found = find(&problem, &selection);
    if found.is_empty() {
        return (problem, selection, found);
    }
    watch("again, without what was left out", 0.2);
    let problem = problem_of(without(logs, &found));
    let selection = select(&problem, watch);
    (problem, selection, found)
}

/// Seconds that are extreme; none where so many are that they are no accidents.
fn find(problem: &Problem, selection: &Selection) -> Vec<LeftOut> {
    let white = selection.whitener.unweighted().apply(&selection.point.residual, &problem.rows);
    let mut seconds: BTreeMap<(usize, i64), (f64, usize)> = BTreeMap::new();
    let mut flown: BTreeMap<(usize, i64), ()> = BTreeMap::new();
    for c in 0..CHANNELS {
        let mut sums: BTreeMap<(usize, i64), (f64, usize)> = BTreeMap::new();
        for (row, w) in problem.rows[c].iter().zip(&white[c]) {
            let flight = row.flight as usize;
            let at = (flight, problem.records[flight].time[row.sample as usize].floor() as i64);
            flown.insert(at, ());
            let sum = sums.entry(at).or_default();
            (sum.0, sum.1) = (sum.0 + w * w, sum.1 + 1);
        }
        for (at, power) in extreme(&sums) {
            let worst = seconds.entry(at).or_default();
            if power > worst.0 {
                *worst = (power, c);
            }
        }
    }
    if seconds.len() as f64 > (ACCIDENT_SHARE.get() * flown.len() as f64).max(ACCIDENT_SECONDS.get()) {
        return Vec::new();
    }
    let mut out: Vec<LeftOut> = Vec::new();
    for ((flight, second), (power, c)) in seconds {
        let margin = ACCIDENT_MARGIN_S.get();
        let [from, to] = [second as f64 - margin, second as f64 + 1.0 + margin];
        let times = power.sqrt();
        match out.last_mut().filter(|last| last.flight == flight && from <= last.span_s[1]) {
            Some(last) => {
                last.span_s[1] = to;
                if times > last.times {
                    (last.times, last.channel) = (times, NAMES[c].0);
                }
            }
            None => {
                let log = problem.records[flight].name.clone();
                out.push(LeftOut { log, span_s: [from, to], channel: NAMES[c].0, times, flight });
            }
        }
    }
    out
}

/// Of mean squares by second, those that are extreme, as multiples of the median.
fn extreme(sums: &BTreeMap<(usize, i64), (f64, usize)>) -> Vec<((usize, i64), f64)> {
    let logs: Vec<f64> = sums.values().map(|(sum, n)| (sum / *n as f64).max(1e-12).ln()).collect();
    if logs.is_empty() {
        return Vec::new();
    }
    let middle = median(&logs);
    let sd = robust_sd(&logs.iter().map(|l| l - middle).collect::<Vec<_>>());
    let least = ACCIDENT_POWER.get().ln().max(ACCIDENT_DEVIATIONS.get() * sd);
    let all = sums.keys().zip(&logs).filter(|(_, log)| **log - middle > least);
    all.map(|(at, log)| (*at, (log - middle).exp())).collect()
}

/// The logs with what was found out of their usable flight.
fn without(mut logs: Vec<Quality>, found: &[LeftOut]) -> Vec<Quality> {
    for (flight, quality) in logs.iter_mut().enumerate() {
        let holes: Vec<Span> = found.iter().filter(|f| f.flight == flight).map(|f| f.span_s).collect();
        let usable = std::mem::take(&mut quality.usable);
        quality.usable = usable.into_iter().flat_map(|span| spans::without(span, &holes)).collect();
        quality.usable.retain(|span| span[1] - span[0] >= SHORTEST_FLIGHT_S.get());
    }
    logs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_is_extreme_beside_the_others() {
        let noisy = |i: i64| ((0, i), (100.0 * (1.0 + 0.2 * (i as f64).sin()), 100));
        let mut sums: BTreeMap<_, _> = (0..60).map(noisy).collect();
        assert!(extreme(&sums).is_empty());
        sums.insert((0, 30), (1e4, 100));
        assert_eq!(extreme(&sums).iter().map(|(at, _)| *at).collect::<Vec<_>>(), [(0, 30)]);
        // Where seconds differ a lot anyway, it is one of them.
        let wild: BTreeMap<_, _> = (0..60).map(|i| ((0, i), ((3.0 * (i as f64).sin()).exp(), 1))).collect();
        assert!(extreme(&wild).is_empty());
    }
}
