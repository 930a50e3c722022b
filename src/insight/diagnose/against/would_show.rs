//! The smallest differences that flights would have shown.

use super::change::WouldShow;
use super::columns::Tested;
use super::suspect::Suspect;
use crate::insight::criteria::flown::SEEN_DEVIATIONS;
use crate::insight::diagnose::prediction::problem::Problem;
use std::collections::BTreeMap;

/// Of each suspect, each number where it is seen best. An effect of several, such as a gyro's scales, may be plain
/// about one axis and hidden about another that hardly turned.
pub fn all(problem: &Problem, tested: &[Tested], suspects: &[Suspect]) -> Vec<WouldShow> {
    let mut sizes: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for t in tested {
        let suspect = &suspects[t.suspect];
        let first = suspect.numbers.start;
        let alike = |k: &usize| problem.model.numbers[*k].unit == problem.model.numbers[first].unit;
        let seen: Vec<(usize, f64)> = match &t.direction {
            Some(direction) => direction.start[..1].iter().map(|(k, size)| (*k, size.abs())).collect(),
            // Of a polynomial no coefficient is a size by itself.
            None if suspect.card.is_none() => vec![(first, 1.0)],
            None => suspect.own.iter().map(|&k| (k, 1.0)).collect(),
        };
        for (i, (k, size)) in seen.into_iter().enumerate().filter(|(_, (k, _))| alike(k)) {
            let spread = t.score.blocks.iter().map(|(_, u)| u[(i, 0)].powi(2)).sum::<f64>().sqrt();
            let smallest = SEEN_DEVIATIONS.get() * spread / t.score.information[i].max(1e-300) * size;
            sizes.entry((t.suspect, k)).and_modify(|known| *known = known.min(smallest)).or_insert(smallest);
        }
    }
    let one = |(i, suspect): (usize, &Suspect)| {
        let of = || sizes.range((i, 0)..(i + 1, 0)).map(|(_, size)| *size);
        let (smallest, worst_axis) = (of().min_by(f64::total_cmp)?, of().max_by(f64::total_cmp)?);
        let unit = suspect.own.first().map_or("1", |&k| problem.model.numbers[k].unit);
        let large = suspect.card.map(|card| card.parameters[0].typical[1]);
        Some(WouldShow { cause: suspect.id, name: suspect.name, smallest, worst_axis, large, unit })
    };
    suspects.iter().enumerate().filter_map(one).collect()
}
