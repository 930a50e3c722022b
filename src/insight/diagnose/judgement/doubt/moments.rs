//! A rate loop holds against the moments of the air with an error, which goes with the velocity: a pilot who commands
//! it away makes small commands do less than large ones.

use super::alone::Alone;
use crate::insight::criteria::unseen::MOMENT_SHARE;
use crate::insight::diagnose::prediction::channels::RATE;
use crate::insight::diagnose::prediction::problem::{ChannelValues, ResidualRow};
use crate::insight::diagnose::selection::fitted::FittedSelection;

/// What all channels say beside rates that each axis may have with each velocity of the body; none where these do not
/// tell them.
pub fn beside<'a>(fitted: &'a FittedSelection<'a>) -> Option<Alone<'a>> {
    let problem = fitted.problem;
    let along = |axis: usize, of: usize| {
        let at = |row: &ResidualRow| problem.records[row.flight as usize].velocity[of][row.sample as usize];
        let mut values = ChannelValues::default();
        values[RATE + axis] = problem.rows[RATE + axis].iter().map(at).collect();
        fitted.selection.whitener.apply(&values, &problem.rows)
    };
    let moments: Vec<_> = (0..9).map(|form| along(form / 3, form % 3)).collect();
    Alone::of(fitted, |_| true, ChannelValues::clone, &moments)
}

/// Whether so small a share of an effect is left beside them that they may be what it is.
pub fn may_be((share, _): (f64, f64)) -> bool {
    share < MOMENT_SHARE.get()
}
