//! What some of the channels by themselves say of fitted numbers: one step of the fit with those channels alone.

use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::ChannelValues;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use crate::insight::estimate::jackknife::jackknife;
use crate::model::effects::Card;
use nalgebra::{DMatrix, DVector};

/// How numbers would move, and how sure that is.
pub struct Alone<'a> {
    fitted: &'a FittedSelection<'a>,
    /// Places of the numbers among the fitted ones.
    places: Vec<usize>,
    moved: DMatrix<f64>,
    covariance: DMatrix<f64>,
}

impl<'a> Alone<'a> {
    /// The fitted numbers of `which`, by the channels that `keep` leaves, beside what any share of `others` explains,
    /// which are whitened; none where these do not tell them.
    pub fn of(
        fitted: &'a FittedSelection<'a>,
        which: impl Fn(usize) -> bool,
        keep: impl Fn(&ChannelValues) -> ChannelValues,
        others: &[ChannelValues],
    ) -> Option<Self> {
        let (problem, point) = (fitted.problem, fitted.point());
        let columns: Vec<ChannelValues> = point.white.iter().map(&keep).collect();
        let shown = |i: &usize| which(point.free[*i]) && columns[*i].iter().any(|c| !c.is_empty());
        let places: Vec<usize> = (0..point.free.len()).filter(shown).collect();
        let residual = keep(&fitted.selection.whitener.apply(&point.residual, &problem.rows));
        let known = places.iter().map(|&i| problem.model.numbers[point.free[i]].trust.powi(-2));
        let prior: Vec<f64> = known.chain(others.iter().map(|_| 0.0)).collect();
        let all: Vec<&ChannelValues> = places.iter().map(|&i| &columns[i]).chain(others).chain([&residual]).collect();
        let (moved, covariance) = step(&Grams::new(&all, &problem.rows, problem.blocks), &prior)?;
        Some(Self { fitted, places, moved, covariance })
    }

    /// The share of the effect's fitted size that these channels show, along itself, and its standard deviation; none
    /// where it has no size, or they are not about it.
    pub fn share(&self, card: &Card) -> Option<(f64, f64)> {
        let point = self.fitted.point();
        let own = span(card);
        let mine: Vec<usize> = (0..self.places.len()).filter(|&i| own.contains(&point.free[self.places[i]])).collect();
        let size = DVector::from_iterator(mine.len(), mine.iter().map(|&i| point.x[point.free[self.places[i]]]));
        let square = size.norm_squared();
        if square == 0.0 {
            return None;
        }
        let along: f64 = mine.iter().zip(size.iter()).map(|(&i, s)| (s + self.moved[(i, 0)]) * s).sum();
        let spread = Grams::pick(&self.covariance, &mine, &mine);
        let sd = (size.transpose() * spread * &size)[(0, 0)].max(0.0).sqrt() / square;
        Some((along / square, sd))
    }
}

/// How far the residual, the last column, moves the size of each other one, and the covariance of that.
fn step(grams: &Grams, prior: &[f64]) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
    let n = prior.len();
    let own: Vec<usize> = (0..n).collect();
    let inner = inverse(&Grams::pick(&grams.sum, &own, &own), prior)?;
    let (covariance, _) = jackknife(grams, &own, n, prior, 1)?;
    Some((inner * Grams::pick(&grams.sum, &own, &[n]), covariance))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_column_explains_leaves_nothing_of_a_size() {
        let at = |i: i32, rate: f64| (rate * f64::from(i)).sin();
        let column = |of: &dyn Fn(i32) -> f64| [(0..400).map(of).collect::<Vec<_>>()];
        // A size of 1 was fitted to what in truth is the other column.
        let (effect, other) = (|i: i32| at(i, 0.1) + at(i, 0.23), |i: i32| at(i, 0.1));
        let residual = column(&|i| other(i) - effect(i));
        let rows = [(0..400).map(|i| i / 20).collect::<Vec<u32>>()];
        let moved = |columns: &[&[Vec<f64>; 1]]| {
            let grams = Grams::new(columns, &rows, 20);
            step(&grams, &vec![0.0; columns.len() - 1]).expect("told").0[(0, 0)]
        };
        let (effect, other) = (column(&effect), column(&other));
        assert!(
            (moved(&[&effect, &residual]) + 0.5).abs() < 0.05,
            "half of it is as much as the data say by themselves"
        );
        assert!((moved(&[&effect, &other, &residual]) + 1.0).abs() < 1e-9);
    }
}
