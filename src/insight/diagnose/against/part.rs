//! A whole that changed in one of its parts alone is that part: a delay of all commands where the throttle is late.

use super::suspect::Suspect;
use crate::insight::criteria::changed::PART_SHARE;
use crate::insight::diagnose::fitting::fit::{self, FitPoint};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;

/// The place among the `suspects` of the only part of `whole`, fitted at `with`, that differs; none where all do, or
/// where it is the whole of nothing.
pub fn only(
    problem: &Problem,
    selection: &Selection,
    suspects: &[Suspect],
    whole: &Suspect,
    with: &FitPoint,
) -> Option<usize> {
    let ids = whole.card?.parts;
    let parts: Vec<usize> = ids.iter().filter_map(|id| suspects.iter().position(|s| s.id == *id)).collect();
    let size = |s: &Suspect| Some((s.numbers.start, *s.own.first()?));
    let (number, difference) = size(whole)?;
    let at: Vec<(usize, usize)> = parts.iter().map(|&p| size(&suspects[p])).collect::<Option<_>>()?;
    if at.is_empty() || at.iter().any(|(_, d)| selection.point.free.contains(d)) {
        return None;
    }
    let mut x = with.x.clone();
    for &(k, d) in &at {
        let bounds = &problem.model.numbers[k];
        x[k] = (x[k] + x[number]).clamp(bounds.low, bounds.high);
        x[d] = x[difference];
    }
    (x[number], x[difference]) = (0.0, 0.0);
    let unknown = |k: &usize| !selection.point.free.contains(k);
    let own: Vec<usize> = at.iter().flat_map(|&(k, d)| [k, d]).filter(unknown).collect();
    let point = fit::refit(problem, &selection.whitener, &selection.point, &own, &x);
    let moved = |i: &usize| point.x[at[*i].1].abs();
    let most = (0..at.len()).max_by(|a, b| moved(a).total_cmp(&moved(b)))?;
    let others = (0..at.len()).filter(|i| *i != most);
    (others.map(|i| moved(&i)).fold(0.0, f64::max) < PART_SHARE.get() * moved(&most)).then_some(parts[most])
}
