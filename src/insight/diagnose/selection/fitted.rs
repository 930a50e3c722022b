//! The end of a selection, with everything linear about it.

use super::Selection;
use crate::insight::diagnose::fitting::fit::{FitPoint, covariance};
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::estimate::gram::Grams;
use crate::model::effects::Card;
use nalgebra::DMatrix;

/// Everything linear about the end of a selection.
pub struct FittedSelection<'a> {
    pub problem: &'a Problem,
    pub selection: &'a Selection,
    /// Of the fitted numbers.
    pub covariance: DMatrix<f64>,
    /// Of the fitted numbers' columns and the residual, the last.
    pub grams: Grams,
}

impl<'a> FittedSelection<'a> {
    pub fn new(problem: &'a Problem, selection: &'a Selection) -> Self {
        let point = &selection.point;
        let grams = point.grams(problem, &selection.whitener);
        let n = point.free.len();
        let covariance = covariance(problem, &selection.whitener, point).unwrap_or(DMatrix::zeros(n, n));
        Self { problem, selection, covariance, grams }
    }

    pub fn point(&self) -> &FitPoint {
        &self.selection.point
    }

    /// Places of an effect's numbers among the fitted ones.
    pub fn places(&self, card: &Card) -> Vec<usize> {
        span(card).filter_map(|k| self.point().free.iter().position(|f| *f == k)).collect()
    }

    /// Places of the other numbers.
    pub fn rest(&self, own: &[usize]) -> Vec<usize> {
        (0..self.point().free.len()).filter(|i| !own.contains(i)).collect()
    }
}
