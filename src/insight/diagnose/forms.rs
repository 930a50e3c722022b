//! Directions of form: those that effects declare, and what the rate response of a real flight controller has beside a
//! lag and a delay.

use crate::model::effects::{Card, Form, MODEL};

/// The rate response is bent by the simulated rate's change so long before, s: at each time on each axis.
pub const TAPS_S: [f64; 4] = [0.01, 0.025, 0.05, 0.1];
/// A bend of the response by so much, s, is about that of a short lag.
pub const TAP_S: f64 = 0.002;
/// How many numbers bend the response.
pub const RESPONSE: usize = 3 * TAPS_S.len();

/// How many numbers bend anything.
pub const COUNT: usize = RESPONSE + declared(MODEL.len());

/// Forms that the first `n` effects of the simulator declare.
pub const fn declared(n: usize) -> usize {
    let (mut sum, mut i) = (0, 0);
    while i < n {
        sum += MODEL[i].forms.len();
        i += 1;
    }
    sum
}

/// All declared forms, in the order of their numbers.
pub fn all() -> impl Iterator<Item = (&'static Card, &'static Form)> {
    MODEL.into_iter().flat_map(|card| card.forms.iter().map(move |form| (card, form)))
}
