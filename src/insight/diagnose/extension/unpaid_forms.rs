//! A form is extrapolated where a size is not: those that do not pay on unseen flight are given up.

use crate::insight::criteria::unseen::PAYS_DEVIATIONS;
use crate::insight::diagnose::fitting::unseen::parts;
use crate::insight::diagnose::judgement::pays::pays;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::fitted::FittedSelection;

/// The same without the forms of effects that do not surely pay on unseen flight, fitted again.
pub fn given_up(problem: &Problem, selection: Selection) -> Selection {
    let free = &selection.point.free;
    let forms = selection.added.iter().flat_map(|a| a.card.forms.iter().map(|i| span(a.card).start + i));
    let fitted: Vec<(usize, usize)> = forms.filter_map(|k| Some((k, free.iter().position(|f| *f == k)?))).collect();
    if fitted.is_empty() {
        return selection;
    }
    let places: Vec<Vec<usize>> = fitted.iter().map(|(_, place)| vec![*place]).collect();
    let paid = pays(&FittedSelection::new(problem, &selection), &parts(problem), &places);
    let unpaid = fitted.iter().zip(paid).filter(|(_, paid)| paid.surely() < PAYS_DEVIATIONS.get());
    let numbers: Vec<usize> = unpaid.map(|((k, _), _)| *k).collect();
    selection.with_given(problem, &numbers)
}
