//! The size of an effect: whether anybody would notice it, and whether it ended where the search does.

use crate::insight::criteria::material::MATERIAL_SIZE;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects::Card;

/// Whether a size of an effect ends at the bound of its range: then it stands in for something else. A form may.
pub fn is_bounded(problem: &Problem, card: &Card, x: &[f64]) -> bool {
    let at_end = |k: usize| {
        let n = &problem.model.numbers[k];
        x[k] != 0.0 && (x[k] <= n.low || x[k] >= n.high)
    };
    span(card).enumerate().any(|(i, k)| !card.forms.contains(&i) && at_end(k))
}

/// Whether the size of an effect is one that anybody would notice.
pub fn is_material(card: &Card, x: &[f64]) -> bool {
    let from = span(card).start;
    card.sizes().map(|(i, p)| (x[from + i] / p.typical[0]).powi(2)).sum::<f64>().sqrt() >= MATERIAL_SIZE.get()
}
