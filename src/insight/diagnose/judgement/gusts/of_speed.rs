//! What of a horizontal force goes with the vehicle's own velocity: a drag of another form, and no gust.

use crate::insight::diagnose::prediction::channels::FORCE;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::estimate::inverse::inverse;
use nalgebra::{DMatrix, DVector};

/// Forms of a drag along one axis.
const FORMS: usize = 8;

/// The residual `y` of the force along `axis` less what forms of a drag explain of it.
pub fn without(problem: &Problem, selection: &Selection, axis: usize, y: &[f64]) -> Vec<f64> {
    let rows = &problem.rows[FORCE + axis];
    let of_row = |row: &usize| {
        let (f, i) = (rows[*row].flight as usize, rows[*row].sample as usize);
        let v = problem.records[f].velocity.each_ref().map(|v| v[i]);
        forms(v, axis, selection.point.state[f].force[i][2].abs())
    };
    let columns: Vec<[f64; FORMS]> = (0..rows.len()).map(|row| of_row(&row)).collect();
    let mut gram = DMatrix::zeros(FORMS, FORMS);
    let mut along = DVector::zeros(FORMS);
    for (forms, y) in columns.iter().zip(y) {
        let forms = DVector::from_column_slice(forms);
        gram.ger(1.0, &forms, &forms, 1.0);
        along.axpy(*y, &forms, 1.0);
    }
    let Some(inner) = inverse(&gram, &[0.0; FORMS]) else { return y.to_vec() };
    let sizes = inner * along;
    let explained = |forms: &[f64; FORMS]| forms.iter().zip(sizes.iter()).map(|(form, size)| form * size).sum::<f64>();
    columns.iter().zip(y).map(|(forms, y)| y - explained(forms)).collect()
}

/// By the speed along the axis, its root and its square, the whole speed, the thrust and its root, and the climb.
fn forms(v: [f64; 3], axis: usize, thrust: f64) -> [f64; FORMS] {
    let (own, all) = (v[axis], v.iter().map(|v| v * v).sum::<f64>().sqrt());
    [1.0, own.abs().sqrt(), own.abs(), all, all * all, thrust, thrust.sqrt(), v[2]].map(|factor| own * factor)
}
