//! Whether what is left of the horizontal force belongs to places in the world: a fan, the lee of a building. No signal
//! of the vehicle tells that, because the same place pushes another way when the vehicle has turned.

use super::folds::fold;
use super::pushes::pushes;
use crate::insight::criteria::complete::{PLACE_ROWS, PLACE_SHARE};
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use std::collections::{BTreeMap, HashMap};

/// Side of a place, m.
const SIDE_M: f64 = 6.0;

/// Share of the horizontal residual that its mean at the same place, at other times, predicts beyond chance; none below
/// a share that matters.
pub fn share(problem: &Problem, residual: &ChannelValues) -> Option<f64> {
    let (mut places, mut force) = (Vec::new(), Vec::new());
    for push in pushes(problem, residual).iter().flat_map(BTreeMap::values) {
        let position = &problem.records[push.row.flight as usize].position;
        let place = [0, 1].map(|k| position[k][push.row.sample as usize] / SIDE_M);
        if place.iter().any(|p| !p.is_finite()) {
            return None;
        }
        places.push((fold(push.row.block), place.map(|p| p.floor() as i32)));
        force.push(push.force);
    }
    if force.is_empty() {
        return None;
    }
    // What a shifted residual shows of this is chance.
    let n = force.len();
    let chance = (1..=4).map(|k| predicted(&places, &force, k * n / 5)).fold(0.0, f64::max);
    Some(predicted(&places, &force, 0) - chance).filter(|share| *share > PLACE_SHARE.get())
}

/// Share that the means of the other folds predict, with the force taken from so many rows later.
fn predicted(places: &[(u32, [i32; 2])], force: &[[f64; 2]], later: usize) -> f64 {
    let at = |i: usize| force[(i + later) % force.len()];
    let mut whole: HashMap<[i32; 2], [f64; 3]> = HashMap::new();
    let mut part: HashMap<(u32, [i32; 2]), [f64; 3]> = HashMap::new();
    for (i, &(fold, place)) in places.iter().enumerate() {
        let [x, y] = at(i);
        for sums in [whole.entry(place).or_default(), part.entry((fold, place)).or_default()] {
            *sums = [sums[0] + x, sums[1] + y, sums[2] + 1.0];
        }
    }
    let known = PLACE_ROWS.get();
    let (mut left, mut total) = (0.0, 0.0);
    for (i, &(fold, place)) in places.iter().enumerate() {
        let (all, own) = (whole[&place], part[&(fold, place)]);
        let seen = all[2] - own[2];
        for (k, y) in at(i).into_iter().enumerate() {
            let mean = if seen < known { 0.0 } else { (all[k] - own[k]) / seen };
            left += (y - mean).powi(2);
            total += y * y;
        }
    }
    1.0 - left / f64::max(total, 1e-300)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A push at one place counts, the same pushes at any place do not.
    #[test]
    fn a_place_is_told_from_a_time() {
        let places: Vec<(u32, [i32; 2])> = (0..60_000).map(|i| (fold(i / 200), [(i / 1000) as i32 % 4, 0])).collect();
        let at_one: Vec<[f64; 2]> = places.iter().map(|p| [if p.1[0] == 2 { 1.0 } else { 0.0 }, 0.0]).collect();
        assert!(predicted(&places, &at_one, 0) > 0.95);
        let any: Vec<[f64; 2]> = (0..60_000).map(|i| [if i / 3100 % 2 == 0 { 1.0 } else { -1.0 }, 0.0]).collect();
        assert!(predicted(&places, &any, 0) < 0.05);
    }
}
