//! What the model gets wrong of both sets of flights alike is no difference: residuals along functions of what is flown
//! count for nothing, whatever they are worth in both sets together. Without that a difference stands in the noise of
//! the compact model's own errors, which are larger than the sensors'.

use super::flown::directions;
use crate::base::stats::median;
use crate::insight::diagnose::fitting::fit::whitened_slopes;
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::channels::CHANNELS;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::candidates::{candidates, causes};
use crate::insight::diagnose::selection::left_over::left_over;
use crate::insight::estimate::gram::dot;
use crate::insight::estimate::inverse::inverse;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Ridge of the regression on them, as a share of their own squares.
const RIDGE: f64 = 1e-6;

/// The noise of both sets, each by itself and without what is a function of what is flown; deaf to such functions. It
/// is as loud in each channel as its stretches of time disagree: a rate loop that no model has leaves ten times what
/// the gyro's noise would.
pub fn deaf(problem: &Problem, selection: &Selection) -> Whitener {
    let Selection { point, whitener, .. } = selection;
    let directions = directions(problem, selection);
    let held = |k: usize| point.free.contains(&k);
    let cards: Vec<_> = causes(problem).into_iter().filter(|card| !span(card).any(held)).collect();
    let found = candidates(problem, whitener, point, &cards);
    let Some(mut left) = left_over(problem, whitener, point, &found) else { return whitener.clone() };
    left.par_iter_mut().zip(&directions).for_each(|(left, directions)| take_off(left, directions));
    let noise = Whitener::of(&left, &problem.rows);
    // What the model has of its own is heard: it is fitted.
    let own = whitened_slopes(problem, &noise, &point.state, &point.x, &point.free);
    let deaf = noise.deaf_to(&directions, &own, &problem.rows);
    let white = deaf.apply(&left, &problem.rows);
    let columns: Vec<ChannelValues> = found.par_iter().map(|f| deaf.apply(&f.change, &problem.rows)).collect();
    let columns: Vec<&ChannelValues> = own.iter().chain(&columns).collect();
    let times: Vec<f64> = (0..CHANNELS).into_par_iter().map(|c| dispersion(problem, &white, &columns, c)).collect();
    deaf.louder(&times.try_into().expect("as many as there are channels"))
}

/// How many times as much as white noise would, stretches of a channel speak for and against `columns`.
fn dispersion(problem: &Problem, white: &ChannelValues, columns: &[&ChannelValues], c: usize) -> f64 {
    let ratio = |column: &&ChannelValues| {
        let (column, rows) = (&column[c], &problem.rows[c]);
        let mut spoken = vec![0.0; problem.blocks];
        let said = column.iter().zip(&white[c]).zip(rows);
        said.for_each(|((x, left), row)| spoken[row.block as usize] += x * left);
        let expected: f64 = column.iter().map(|x| x * x).sum();
        (expected > 0.0).then(|| spoken.iter().map(|s| s * s).sum::<f64>() / expected)
    };
    let ratios: Vec<f64> = columns.iter().filter_map(ratio).collect();
    if ratios.is_empty() { 1.0 } else { median(&ratios).max(1.0).sqrt() }
}

/// Takes off a channel what it has of `directions`.
fn take_off(left: &mut [f64], directions: &[Vec<f64>]) {
    let n = directions.len();
    let square = DMatrix::from_fn(n, n, |i, j| dot(&directions[i], &directions[j]));
    let ridge: Vec<f64> = (0..n).map(|i| RIDGE * square[(i, i)]).collect();
    let Some(inner) = inverse(&square, &ridge) else { return };
    let weights = inner * DVector::from_iterator(n, directions.iter().map(|d| dot(d, left)));
    for (direction, weight) in directions.iter().zip(weights.iter()) {
        left.iter_mut().zip(direction).for_each(|(l, d)| *l -= weight * d);
    }
}
