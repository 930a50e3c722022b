//! First bend, then add: what is left beside a delay or an order of the rates is explained by the form of their
//! response before another cause is looked for, and what is left beside a cause of the thrust by how thrust goes with
//! throttle and voltage.

use super::bends;
use super::fit::{self, FitPoint};
use super::problem::Problem;
use super::whiten::Whitener;
use crate::insight::criteria::evident::LEAST_GAIN;
use crate::model::effects::Card;

/// `point` with the response or the thrust bent, where one of `held` is about it and the bend is evident.
pub fn bend(problem: &Problem, whitener: &Whitener, point: FitPoint, held: &[&'static Card]) -> FitPoint {
    bend_by(problem, whitener, point, bends::open(held))
}

/// The same by the numbers `open`.
pub fn bend_by(problem: &Problem, whitener: &Whitener, point: FitPoint, open: impl Iterator<Item = usize>) -> FitPoint {
    let numbers = &problem.model.numbers;
    let known = |k: &usize| numbers[*k].high > numbers[*k].low && !point.free.contains(k);
    let open: Vec<usize> = open.filter(known).collect();
    if open.is_empty() {
        return point;
    }
    let x = point.x.clone();
    let bent = fit::refit(problem, whitener, &point, &open, &x);
    // Each number takes one of the whitened squares by chance.
    if point.total() - bent.total() > LEAST_GAIN.get() + open.len() as f64 {
        fit::fit(problem, whitener, &bent.x, &bent.free)
    } else {
        point
    }
}
