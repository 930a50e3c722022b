//! What of a horizontal force goes with the vehicle's own velocity: a drag of another form or one that changes in the
//! flight, and no gust.

use crate::insight::diagnose::prediction::channels::FORCE;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::estimate::inverse::inverse;
use nalgebra::{DMatrix, DVector};

/// Forms of a drag along one axis.
const FORMS: usize = 8;

/// The residual `y` of the force along `axis` less what forms of a drag explain of it, which may change in so many
/// `parts` of the flight.
pub fn without(problem: &Problem, selection: &Selection, axis: usize, y: &[f64], parts: usize) -> Vec<f64> {
    let of_rows = problem.rows[FORCE + axis].iter().map(|row| {
        let (f, i) = (row.flight as usize, row.sample as usize);
        let v = problem.records[f].velocity.each_ref().map(|v| v[i]);
        let part = row.block as usize * parts / problem.blocks;
        columns(forms(v, axis, selection.point.state[f].force[i][2].abs()), part, parts)
    });
    less(&of_rows.collect::<Vec<_>>(), y)
}

/// What is left of `y` beside the sum of columns that comes nearest to it.
fn less(rows: &[Vec<f64>], y: &[f64]) -> Vec<f64> {
    let n = rows.first().map_or(0, Vec::len);
    let mut gram = DMatrix::zeros(n, n);
    let mut along = DVector::zeros(n);
    for (row, y) in rows.iter().zip(y) {
        let row = DVector::from_column_slice(row);
        gram.ger(1.0, &row, &row, 1.0);
        along.axpy(*y, &row, 1.0);
    }
    let Some(inner) = inverse(&gram, &vec![0.0; n]) else { return y.to_vec() };
    let sizes = inner * along;
    let explained = |row: &[f64]| row.iter().zip(sizes.iter()).map(|(form, size)| form * size).sum::<f64>();
    rows.iter().zip(y).map(|(row, y)| y - explained(row)).collect()
}

/// The forms, and what the linear and the square one change by in each later part.
fn columns(forms: [f64; FORMS], part: usize, parts: usize) -> Vec<f64> {
    let change = |later: usize| [LINEAR, SQUARE].map(|form| if part == later { forms[form] } else { 0.0 });
    forms.into_iter().chain((1..parts).flat_map(change)).collect()
}

/// Where two of the [`forms`] stand.
const LINEAR: usize = 0;
const SQUARE: usize = 3;

/// By the speed along the axis, its root and its square, the whole speed, the thrust and its root, and the climb.
fn forms(v: [f64; 3], axis: usize, thrust: f64) -> [f64; FORMS] {
    let (own, all) = (v[axis], v.iter().map(|v| v * v).sum::<f64>().sqrt());
    [1.0, own.abs().sqrt(), own.abs(), all, all * all, thrust, thrust.sqrt(), v[2]].map(|factor| own * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drag with an exponent that is no form of its own leaves nothing, nor does one that sets in; air that moves by
    /// itself leaves nearly all.
    #[test]
    fn a_drag_of_another_form_goes_with_speed_and_a_gust_does_not() {
        let at = |i: usize, rate: f64| (0.1 * rate * i as f64).sin();
        let speeds = |i: usize| [9.0 * at(i, 1.0), 7.0 * at(i, 1.3), 3.0 * at(i, 0.7)];
        let left = |y: &dyn Fn(usize) -> f64, parts: usize| {
            let row = |i: usize| columns(forms(speeds(i), 0, 12.0 + 5.0 * at(i, 2.1)), i * parts / 3000, parts);
            let rows: Vec<_> = (0..3000).map(row).collect();
            let y: Vec<f64> = (0..rows.len()).map(y).collect();
            let squares = |y: &[f64]| y.iter().map(|y| y * y).sum::<f64>();
            squares(&less(&rows, &y)) / squares(&y)
        };
        assert!(left(&|i| speeds(i)[0] * speeds(i)[0].abs().powf(0.7), 1) < 1e-3);
        let whole = |i: usize| speeds(i).iter().map(|v| v * v).sum::<f64>().sqrt();
        let sets_in = |i: usize| if i < 1500 { 0.0 } else { speeds(i)[0] * whole(i) };
        assert!(left(&sets_in, 1) > 0.3 && left(&sets_in, 4) < 1e-3);
        assert!(left(&|i| at(i, 2.9), 4) > 0.8);
    }
}
