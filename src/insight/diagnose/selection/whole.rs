//! One cause where one will do, and two where it takes two: effects that are the whole of others at one size.

use super::{Added, Selection};
use crate::insight::criteria::rival::{SAME_DELAY_S, SAME_DELAY_SHARE};
use crate::insight::diagnose::fitting::fit;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects::{self, Card};

/// Puts a whole in the place of its parts where they have one size, and parts in the place of a whole that needs one of
/// them beside itself.
pub fn parts(problem: &Problem, selection: &mut Selection) {
    for whole in effects::cards().filter(|card| !card.parts.is_empty()) {
        let parts: Vec<&'static Card> = whole.parts.iter().filter_map(|id| effects::card(id)).collect();
        let held = |card: &Card| selection.added.iter().any(|a| a.card.id == card.id);
        let size = |card: &Card| selection.point.x[span(card).start];
        let (has_whole, has) = (held(whole), parts.iter().filter(|part| held(part)).count());
        let sizes: Vec<f64> = parts.iter().map(|part| size(part)).collect();
        if has_whole && has > 0 {
            let total = size(whole);
            let sizes: Vec<f64> = sizes.iter().map(|part| part + total).collect();
            exchange(problem, selection, &[whole], &parts, &sizes);
        } else if !has_whole && has == parts.len() && same(&sizes) {
            let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
            exchange(problem, selection, &parts, &[whole], &[mean]);
        }
    }
}

/// Whether sizes are the same, as far as they are known.
fn same(sizes: &[f64]) -> bool {
    let (least, most) = sizes.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), s| (l.min(*s), m.max(*s)));
    most - least <= SAME_DELAY_S.get() + SAME_DELAY_SHARE.get() * most.abs()
}

/// The selection with `new` effects of `sizes` in the place of the `old` ones, fitted again.
fn exchange(problem: &Problem, selection: &mut Selection, old: &[&'static Card], new: &[&'static Card], sizes: &[f64]) {
    let mut x = selection.point.x.clone();
    let mut free = selection.point.free.clone();
    let gone: Vec<usize> = old.iter().chain(new).flat_map(|card| span(card)).collect();
    gone.iter().for_each(|&k| x[k] = 0.0);
    free.retain(|k| !gone.contains(k));
    let is_gone = |a: &Added| old.iter().chain(new).any(|card| card.id == a.card.id);
    let at = selection.added.iter().position(is_gone).unwrap_or(0);
    selection.added.retain(|a| !is_gone(a));
    for (i, (card, size)) in new.iter().zip(sizes).enumerate() {
        let n = &problem.model.numbers[span(card).start];
        x[span(card).start] = size.clamp(n.low, n.high);
        free.extend(span(card));
        selection.added.insert(at + i, Added { card, ties: Vec::new() });
    }
    selection.point = fit::fit(problem, &selection.whitener, &x, &free);
}

#[cfg(test)]
mod tests {
    use super::same;

    #[test]
    fn sizes_are_the_same_as_far_as_they_are_known() {
        assert!(same(&[0.008, 0.0083]) && !same(&[0.012, 0.015]));
    }
}
