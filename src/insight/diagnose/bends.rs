//! Numbers by which causes are bent. They take part in fits once their cause is in, and in nothing that is written or
//! reported.

use super::forms::{RESPONSE, TAPS_S, all, declared};
use super::numbers::{BEGIN, FORMS};
use crate::model::effects::{Card, CompactNumber, FormOf, MODEL, RateResponse, ResidualChannel};
use std::ops::Range;

/// The numbers that bend an effect of the simulator.
pub fn own(card: &Card) -> Range<usize> {
    let i = MODEL.iter().position(|other| other.id == card.id).unwrap_or(MODEL.len());
    let from = FORMS + RESPONSE + declared(i);
    from..from + if i < MODEL.len() { card.forms.len() } else { 0 }
}

/// Whether a number bends something.
pub fn is_form(k: usize) -> bool {
    (FORMS..BEGIN).contains(&k)
}

/// Whether an effect is about how the rates follow their commands.
fn responds(card: &Card) -> bool {
    let lags = card.absorbed_by.iter().any(|n| *n == CompactNumber::RollTime);
    card.channels == [ResidualChannel::Rate] && (card.response != RateResponse::FirstOrder || lags)
}

/// Groups of numbers that bend the effects `held`.
pub fn groups(held: &[&'static Card]) -> Vec<Vec<usize>> {
    let mut out: Vec<Vec<usize>> =
        held.iter().map(|card| own(card).collect()).filter(|g: &Vec<_>| !g.is_empty()).collect();
    if held.iter().any(|card| responds(card)) {
        out.push((FORMS..FORMS + RESPONSE).collect());
    }
    out
}

/// The bends of this kind that are there at `x`, with their sizes.
pub fn bends(x: &[f64]) -> Vec<(f64, FormOf)> {
    let sizes = &x[FORMS + RESPONSE..BEGIN];
    all().zip(sizes).filter(|(_, size)| **size != 0.0).map(|((_, form), size)| (*size, form.of)).collect()
}

/// By how much each axis' rate is bent at each of [`TAPS_S`], s.
pub fn taps(x: &[f64]) -> Option<[[f64; TAPS_S.len()]; 3]> {
    let n = TAPS_S.len();
    let sizes = &x[FORMS..FORMS + RESPONSE];
    let bent = sizes.iter().any(|size| *size != 0.0);
    bent.then(|| std::array::from_fn(|k| std::array::from_fn(|j| sizes[k * n + j])))
}
