//! What is left of the horizontal force, as a push in the world.

use crate::insight::diagnose::prediction::channels::FORCE;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem, ResidualRow};
use crate::insight::estimate::robust::capped;
use std::collections::BTreeMap;

/// Residuals are capped at so many standard deviations.
const CAP: f64 = 6.0;

/// What is left at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Push {
    pub row: ResidualRow,
    /// East and north, m/s2: of the body's x and y axes. Along z it is the thrust that errs, and where the motors are
    /// at their limits it is not known.
    pub force: [f64; 2],
}

/// What is left, by flight and index of the row.
pub fn pushes(problem: &Problem, residual: &ChannelValues) -> Vec<BTreeMap<u32, Push>> {
    let mut pushes: Vec<BTreeMap<u32, Push>> = vec![BTreeMap::new(); problem.records.len()];
    for axis in 0..2 {
        let left = capped(&residual[FORCE + axis], CAP, 0.0);
        for (row, r) in problem.rows[FORCE + axis].iter().zip(left) {
            let flight = row.flight as usize;
            let along = problem.records[flight].axes[row.sample as usize][axis];
            let push = pushes[flight].entry(row.index).or_insert(Push { row: *row, force: [0.0; 2] });
            push.force = [push.force[0] + r * along[0], push.force[1] + r * along[1]];
        }
    }
    pushes
}
