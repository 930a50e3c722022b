//! First bend, then add: what is left beside a cause is explained by its own family of forms before another cause is
//! looked for.

use super::bends;
use super::fit::{self, FitPoint};
use super::problem::Problem;
use super::whiten::Whitener;
use crate::insight::criteria::evident::LEAST_GAIN;
use crate::model::effects::Card;

/// `point` with the forms of `held` that are evident.
pub fn bend(problem: &Problem, whitener: &Whitener, mut point: FitPoint, held: &[&'static Card]) -> FitPoint {
    for group in bends::groups(held) {
        let open: Vec<usize> = group.into_iter().filter(|k| !point.free.contains(k)).collect();
        if open.is_empty() {
            continue;
        }
        let x = point.x.clone();
        let bent = fit::refit(problem, whitener, &point, &open, &x);
        // Each number takes one of the whitened squares by chance.
        if point.total() - bent.total() > LEAST_GAIN.get() + open.len() as f64 {
            point = fit::fit(problem, whitener, &bent.x, &bent.free);
        }
    }
    point
}
