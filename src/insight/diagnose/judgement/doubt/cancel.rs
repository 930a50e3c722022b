//! Two effects whose parts are opposite over the log and sum to little, or nearly the same.

use crate::insight::criteria::rival::ONE_LIKENESS;
use crate::insight::criteria::unseen::{CANCEL_LEFT, CANCEL_LIKENESS};
use crate::insight::diagnose::prediction::numbers::{place, span};
use crate::insight::diagnose::prediction::problem::ChannelValues;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::model::effects::{self, Card};
use nalgebra::DMatrix;

/// Inner products of what effects add to the prediction, whitened.
pub struct Overlap(DMatrix<f64>);

/// Those of `cards`.
pub fn overlap(fitted: &FittedSelection, cards: &[&'static Card]) -> Overlap {
    let own = |card: &&'static Card| span(card).map(|k| (k, 0.0)).collect();
    of(fitted, &cards.iter().map(own).collect::<Vec<_>>())
}

/// Whether what could take an effect up has moved against the base vehicle's by its opposite: the vehicle's numbers, by
/// themselves or with the other effects that they could take up as well.
pub fn is_undone(fitted: &FittedSelection, card: &Card) -> bool {
    let from_base = |k: usize| (k, fitted.problem.model.base[k]);
    let own: Vec<_> = span(card).map(from_base).collect();
    let numbers: Vec<_> = card.absorbed_by.iter().flat_map(|n| place(*n)).map(from_base).collect();
    if numbers.is_empty() {
        return false;
    }
    let shares = |other: &&Card| other.id != card.id && other.absorbed_by.iter().any(|n| card.absorbed_by.contains(n));
    let others = effects::cards().filter(shares).flat_map(span).map(from_base);
    let all = numbers.iter().copied().chain(others).collect();
    undone(&of(fitted, &[own, numbers, all]).0)
}

/// Whether the first part is undone by the second, or by the third, which has the second in it.
fn undone(gram: &DMatrix<f64>) -> bool {
    cancel(gram, 0, 1) || cancel(gram, 0, 2)
}

/// Of changes of the fitted numbers from these values to what they are.
fn of(fitted: &FittedSelection, from: &[Vec<(usize, f64)>]) -> Overlap {
    let (problem, point) = (fitted.problem, fitted.point());
    let part = |from: &Vec<(usize, f64)>| {
        fitted.selection.whitener.apply(&problem.secant(&point.state, &point.x, from, -1.0), &problem.rows)
    };
    let parts: Vec<ChannelValues> = from.iter().map(part).collect();
    Overlap(Grams::new(&parts.iter().collect::<Vec<_>>(), &problem.rows, problem.blocks).sum)
}

impl Overlap {
    fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        (0..self.0.nrows()).flat_map(|a| (0..a).map(move |b| [b, a]))
    }

    /// Pairs that cancel each other.
    pub fn cancelling(&self) -> impl Iterator<Item = [usize; 2]> {
        self.pairs().filter(|[a, b]| cancel(&self.0, *a, *b))
    }

    /// Pairs that are much the same, the larger part first.
    pub fn alike(&self) -> impl Iterator<Item = [usize; 2]> {
        let gram = &self.0;
        let alike =
            |[a, b]: &[usize; 2]| gram[(*a, *b)] > ONE_LIKENESS.get() * (gram[(*a, *a)] * gram[(*b, *b)]).sqrt();
        self.pairs().filter(alike).map(|[a, b]| if gram[(a, a)] < gram[(b, b)] { [b, a] } else { [a, b] })
    }
}

fn cancel(gram: &DMatrix<f64>, a: usize, b: usize) -> bool {
    let (aa, bb, ab) = (gram[(a, a)], gram[(b, b)], gram[(a, b)]);
    let left = aa + bb + 2.0 * ab;
    ab < -CANCEL_LIKENESS.get() * (aa * bb).sqrt() && left < CANCEL_LEFT.get() * aa.max(bb)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposite_parts_of_one_size_cancel_and_others_do_not() {
        let gram = |aa: f64, bb: f64, ab: f64| DMatrix::from_row_slice(2, 2, &[aa, ab, ab, bb]);
        assert!(cancel(&gram(1.0, 1.1, -1.0), 0, 1));
        assert!(!cancel(&gram(1.0, 1.1, 1.0), 0, 1), "one sign");
        assert!(!cancel(&gram(1.0, 16.0, -3.9), 0, 1), "one is much larger");
        assert!(!cancel(&gram(1.0, 1.0, -0.5), 0, 1), "each has its own");
    }

    #[test]
    fn what_no_other_undoes_alone_may_be_undone_by_several() {
        // Columns: an effect, the vehicle's numbers, and these with another effect.
        let undone = |numbers: [f64; 2], other: [f64; 2]| {
            let all = [numbers[0] + other[0], numbers[1] + other[1]];
            let parts = DMatrix::from_column_slice(2, 3, [[1.0, 0.0], numbers, all].as_flattened());
            super::undone(&(parts.transpose() * parts))
        };
        assert!(undone([-1.0, 0.0], [0.3, 0.3]), "by the numbers alone");
        assert!(undone([-0.5, 0.8], [-0.5, -0.8]), "by both together");
        assert!(!undone([-0.5, 0.8], [0.1, 0.0]), "the other has no part in it");
    }
}
