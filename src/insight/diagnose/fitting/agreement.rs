//! How far attitude and velocity agree with the integrated sensors, without any model of the vehicle.

use super::whiten::Whitener;
use crate::insight::diagnose::prediction::channels::{PUSH, RATE, TURN};
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use std::ops::Range;

/// Whitened squares of what is left in turns and pushes.
pub fn squares(problem: &Problem, whitener: &Whitener, residual: &ChannelValues) -> f64 {
    let all = whitener.apply(&kinematic(residual), &problem.rows);
    all.iter().flatten().map(|r| r * r).sum()
}

/// Whitened squares of all that is left but about yaw.
pub fn squares_but_yaw(problem: &Problem, whitener: &Whitener, residual: &ChannelValues) -> f64 {
    let mut others = residual.clone();
    others[RATE + 2].clear();
    whitener.apply(&others, &problem.rows).iter().flatten().map(|r| r * r).sum()
}

/// The turns and pushes of `values` alone.
pub fn kinematic(values: &ChannelValues) -> ChannelValues {
    only(values, TURN..PUSH + 3)
}

/// These channels of `values` alone.
pub fn only(values: &ChannelValues, channels: Range<usize>) -> ChannelValues {
    std::array::from_fn(|c| if channels.contains(&c) { values[c].clone() } else { Vec::new() })
}
