//! Where the first fit begins.

use crate::insight::diagnose::fitting::fit;
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::effects;

/// The base vehicle, without those of its effects in the later of two sets of flights that these lack: a fit may not
/// come from a delay to none.
pub fn begin(problem: &Problem, whitener: &Whitener) -> Vec<f64> {
    let base = &problem.model.base;
    let Some(contrast) = &problem.contrast else { return base.clone() };
    let left = |x: &[f64]| fit::stay(problem, whitener, x, &[]).total();
    let mut begun = (left(base), base.clone());
    for card in effects::cards().filter(|card| !card.about_full && span(card).any(|k| base[k] != 0.0)) {
        let mut without = begun.1.clone();
        for (k, difference) in span(card).filter_map(|k| Some((k, contrast.of(k)?))) {
            without[difference] = -base[k];
        }
        let squares = left(&without);
        if squares < begun.0 {
            begun = (squares, without);
        }
    }
    begun.1
}
