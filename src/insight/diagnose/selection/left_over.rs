//! What is left when all is taken off that any cause could explain: the noise.

use super::candidates::Candidate;
use crate::insight::diagnose::fitting::fit::FitPoint;
use crate::insight::diagnose::fitting::unseen::seen;
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::insight::estimate::gram::Grams;
use nalgebra::DMatrix;

/// The whitener of what is left when all columns are taken off.
pub fn saturated(problem: &Problem, whitener: &Whitener, point: &FitPoint, found: &[Candidate]) -> Whitener {
    left_over(problem, whitener, point, found).map_or(whitener.clone(), |left| Whitener::of(&left, &problem.rows))
}

/// What is left when all columns are taken off, of each set of flights by itself: a difference of them is no noise.
pub fn left_over(
    problem: &Problem,
    whitener: &Whitener,
    point: &FitPoint,
    found: &[Candidate],
) -> Option<ChannelValues> {
    let residual = whitener.apply(&point.residual, &problem.rows);
    let all: Vec<&ChannelValues> =
        point.white.iter().chain(found.iter().map(|c| &c.white)).chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let sets = problem.sets();
    let each: Vec<DMatrix<f64>> = sets.iter().map(|out| together(&seen(&grams, out))).collect::<Option<_>>()?;
    let mut left = point.residual.clone();
    for (j, column) in point.slopes.iter().chain(found.iter().map(|c| &c.change)).enumerate() {
        for (c, column) in column.iter().enumerate() {
            for ((left, x), row) in left[c].iter_mut().zip(column).zip(&problem.rows[c]) {
                let set = sets.iter().position(|out| !out[row.block as usize]).unwrap_or(0);
                *left -= each[set][(j, 0)] * x;
            }
        }
    }
    Some(left)
}

/// All columns of the inner products `sum` but the last, fitted to the last.
fn together(sum: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = sum.nrows() - 1;
    let own: Vec<usize> = (0..n).collect();
    let square = Grams::pick(sum, &own, &own);
    // Columns at several sizes of one effect are nearly the same: a small ridge decides among them.
    let ridge: Vec<f64> = (0..n).map(|i| 1e-4 * square[(i, i)] + 1e-12).collect();
    Some(crate::insight::estimate::inverse::inverse(&square, &ridge)? * Grams::pick(sum, &own, &[n]))
}
