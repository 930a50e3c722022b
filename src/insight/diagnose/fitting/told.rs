//! The compact model's numbers that flights tell: what predicts flight that was not used for fitting worse than the
//! vehicle that was given is left as it was given.

use super::fit::{self, FitPoint};
use super::unseen::{self, parts, rise};
use super::whiten::Whitener;
use crate::insight::diagnose::prediction::channels::LIFT;
use crate::insight::diagnose::prediction::numbers::THRUST;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::insight::estimate::gram::Grams;

/// The fit of the numbers `free` from `start`, without the thrust where flights at other throttles than the rest are
/// better predicted by the curve that was given: a cubic that is fitted to slow flights says nothing of a fast one.
pub fn told(problem: &Problem, whitener: &Whitener, start: &[f64], free: &[usize]) -> FitPoint {
    let fit = |free: &[usize]| fit::fit(problem, whitener, start, free);
    let fitted = fit(free);
    let given: Vec<usize> = free.iter().copied().filter(|k| !THRUST.contains(k)).collect();
    if given.len() == free.len() || problem.rows[LIFT].is_empty() {
        return fitted;
    }
    let held = fit(&given);
    let [before, after] = [&held, &fitted].map(|point| lift_unseen(problem, whitener, point));
    if rise(&before, &after).is_some() { held } else { fitted }
}

/// Squares of the residuals of the specific force along the rotors' axis by stretch of time, each predicted by numbers
/// that were fitted without it.
fn lift_unseen(problem: &Problem, whitener: &Whitener, point: &FitPoint) -> Vec<f64> {
    let white = whitener.apply(&point.residual, &problem.rows);
    let columns: Vec<&ChannelValues> = point.white.iter().chain([&white]).collect();
    let grams = Grams::new(&columns, &problem.rows, problem.blocks);
    let mut squares = vec![0.0; problem.blocks];
    for out in parts(problem) {
        let x = unseen::without(problem, whitener, point, &grams, &out);
        let residual = problem.residuals(&problem.predict(&x));
        for (row, r) in problem.rows[LIFT].iter().zip(&residual[LIFT]).filter(|(row, _)| out[row.block as usize]) {
            squares[row.block as usize] += r * r;
        }
    }
    squares
}
