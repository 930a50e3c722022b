//! First bend, then add: what is left beside a delay or an order of the rates is explained by the form of their
//! response before another cause is looked for, and what is left beside a cause of the thrust by how thrust goes with
//! throttle and voltage.

use super::fit::{self, FitPoint};
use super::whiten::Whitener;
use crate::insight::criteria::evident::LEAST_GAIN;
use crate::insight::diagnose::prediction::bends;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects::Card;

/// `point` with the response, the thrust or a lag bent, where one of `held` is about it and the bend is evident.
pub fn bend(problem: &Problem, whitener: &Whitener, point: FitPoint, held: &[&'static Card]) -> FitPoint {
    let numbers = &problem.model.numbers;
    let known = |k: &usize| numbers[*k].high > numbers[*k].low && !point.free.contains(k);
    let open: Vec<usize> = bends::open(held).filter(known).collect();
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
