//! Air that pushes one way in the world for seconds: a wind that turns, or that is not the same everywhere, is no gust.

use super::Selection;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::prediction::record::BIN_S;
use crate::insight::diagnose::structure::pushes::pushes;

/// What is correlated with itself: bins a little apart, which no noise joins, and bins this far apart, s.
const NEAR_S: f64 = 0.06;
const FAR_S: f64 = 4.0;

/// The share of the horizontal force's remainder, as far as it has a memory at all, that points the same way in the
/// world four seconds later.
pub fn lasting(problem: &Problem, selection: &Selection) -> f64 {
    let pushes = pushes(problem, &selection.point.residual);
    let after = |seconds: f64| {
        let lag = (seconds / BIN_S) as u32;
        let pairs = pushes.iter().flat_map(|of| of.iter().filter_map(move |(i, a)| Some((a, of.get(&(i + lag))?))));
        let (sum, n) = pairs
            .fold((0.0, 0.0), |(sum, n), (a, b)| (sum + a.force[0] * b.force[0] + a.force[1] * b.force[1], n + 1.0));
        sum / f64::max(n, 1.0)
    };
    after(FAR_S) / after(NEAR_S).max(1e-12)
}
