//! The residual along a signal, in levels that are equally often met.

use crate::base::stats::quantile;
use crate::insight::diagnose::prediction::problem::{Predictions, Problem};
use crate::insight::diagnose::prediction::signals::signals;
use std::collections::BTreeMap;

const LEVELS: usize = 12;
/// Fewer residuals than this are no level.
const LEAST: usize = 20;

/// Mean residual, before and after, by level of a signal.
pub struct Profile {
    pub signal: &'static str,
    pub unit: &'static str,
    pub levels: Vec<ProfileLevel>,
}

/// Mean of the signal, and means of the residuals with their standard errors.
pub struct ProfileLevel {
    pub signal: f64,
    pub before: [f64; 2],
    pub after: [f64; 2],
}

/// Both residuals of channel `c` along the signal of this name.
pub fn along(problem: &Problem, state: &Predictions, c: usize, name: &str, residuals: [&[f64]; 2]) -> Option<Profile> {
    let (signal, unit, values) = signals(problem, state, c).into_iter().find(|(n, _, _)| *n == name)?;
    let known: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let mut edges: Vec<f64> = (1..=LEVELS).map(|b| quantile(&known, b as f64 / LEVELS as f64)).collect();
    edges.dedup();
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); edges.len()];
    for (i, value) in values.iter().enumerate().filter(|(_, v)| v.is_finite()) {
        members[edges.partition_point(|edge| edge < value).min(edges.len() - 1)].push(i);
    }
    let block: Vec<u32> = problem.rows[c].iter().map(|row| row.block).collect();
    let level = |rows: &Vec<usize>| ProfileLevel {
        signal: rows.iter().map(|&i| values[i]).sum::<f64>() / rows.len() as f64,
        before: average(rows, residuals[0], &block),
        after: average(rows, residuals[1], &block),
    };
    let levels: Vec<ProfileLevel> = members.iter().filter(|rows| rows.len() >= LEAST).map(level).collect();
    (levels.len() > 1).then_some(Profile { signal, unit, levels })
}

/// Mean and its standard error. Residuals of one stretch of time go together; stretches are independent.
fn average(rows: &[usize], residual: &[f64], block: &[u32]) -> [f64; 2] {
    let n = rows.len() as f64;
    let mean = rows.iter().map(|&i| residual[i]).sum::<f64>() / n;
    let mut sums: BTreeMap<u32, f64> = BTreeMap::new();
    rows.iter().for_each(|&i| *sums.entry(block[i]).or_default() += residual[i] - mean);
    [mean, sums.values().map(|s| s * s).sum::<f64>().sqrt() / n]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_together_counts_once() {
        let rows: Vec<usize> = (0..400).collect();
        let signs: Vec<f64> = (0..400).map(|i| if (i / 10) % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let alone: Vec<u32> = (0..400).collect();
        let tens: Vec<u32> = (0..400).map(|i| i / 10).collect();
        let [mean, error] = average(&rows, &signs, &alone);
        assert!(mean.abs() < 1e-12 && (error - 0.05).abs() < 1e-12);
        assert!((average(&rows, &signs, &tens)[1] - 0.05 * 10f64.sqrt()).abs() < 1e-12);
    }
}
