//! What is left in some of the channels: in attitude and velocity against the integrated sensors, which no model of the
//! vehicle enters, or in all but yaw.

use super::whiten::Whitener;
use crate::insight::diagnose::prediction::channels::{PUSH, RATE, TURN};
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use std::ops::Range;

/// Whitened squares of what is left in turns and pushes.
pub fn squares(problem: &Problem, whitener: &Whitener, residual: &ChannelValues) -> f64 {
    whitened(problem, whitener, &kinematic(residual))
}

/// Whitened squares of all that is left but about yaw.
pub fn squares_but_yaw(problem: &Problem, whitener: &Whitener, residual: &ChannelValues) -> f64 {
    let mut others = residual.clone();
    others[RATE + 2].clear();
    whitened(problem, whitener, &others)
}

fn whitened(problem: &Problem, whitener: &Whitener, residual: &ChannelValues) -> f64 {
    whitener.apply(residual, &problem.rows).iter().flatten().map(|r| r * r).sum()
}

/// The turns and pushes of `values` alone.
pub fn kinematic(values: &ChannelValues) -> ChannelValues {
    only(values, TURN..PUSH + 3)
}

/// These channels of `values` alone.
pub fn only(values: &ChannelValues, channels: Range<usize>) -> ChannelValues {
    std::array::from_fn(|c| if channels.contains(&c) { values[c].clone() } else { Vec::new() })
}
