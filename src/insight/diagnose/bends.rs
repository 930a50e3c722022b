//! Numbers by which the rate response is bent. They take part in fits once an effect of the response is in, and in
//! nothing that is written or reported.

use super::forms::TAPS_S;
use super::numbers::{BEGIN, FORMS};
use crate::model::effects::{Card, CompactNumber, RateResponse, ResidualChannel};

/// Whether a number bends something.
pub fn is_form(k: usize) -> bool {
    (FORMS..BEGIN).contains(&k)
}

/// Whether an effect is about how the rates follow their commands.
pub fn responds(card: &Card) -> bool {
    let lags = card.absorbed_by.contains(&CompactNumber::RollTime);
    card.channels == [ResidualChannel::Rate] && (card.response != RateResponse::FirstOrder || lags)
}

/// By how much each axis' rate is bent at each of [`TAPS_S`], s.
pub fn taps(x: &[f64]) -> Option<[[f64; TAPS_S.len()]; 3]> {
    let n = TAPS_S.len();
    let sizes = &x[FORMS..BEGIN];
    let bent = sizes.iter().any(|size| *size != 0.0);
    bent.then(|| std::array::from_fn(|k| std::array::from_fn(|j| sizes[k * n + j])))
}
