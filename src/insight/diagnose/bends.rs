//! Numbers by which the rate response and the thrust are bent. They take part in fits once an effect of the same is in,
//! and in nothing that is written or reported.

use super::forms::{self, TAPS_S};
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

/// Whether an effect is about how much thrust a command gives.
pub fn thrusts(card: &Card) -> bool {
    card.absorbed_by.contains(&CompactNumber::Thrust)
}

/// The numbers that bend what effects of `held` are about.
pub fn open(held: &[&'static Card]) -> impl Iterator<Item = usize> {
    let [response, thrust] = [responds, thrusts].map(|about| held.iter().any(|card| about(card)));
    (FORMS..BEGIN).filter(move |k| if *k < THRUST { response } else { thrust })
}

/// Where those of the thrust begin.
pub const THRUST: usize = FORMS + forms::RESPONSE;

/// By how much the thrust is bent by each of [`forms::thrust`], m/s2.
pub fn thrust(x: &[f64]) -> Option<&[f64]> {
    let sizes = &x[THRUST..BEGIN];
    sizes.iter().any(|size| *size != 0.0).then_some(sizes)
}

/// By how much each axis' rate is bent at each of [`TAPS_S`], s.
pub fn taps(x: &[f64]) -> Option<[[f64; TAPS_S.len()]; 3]> {
    let n = TAPS_S.len();
    let sizes = &x[FORMS..THRUST];
    let bent = sizes.iter().any(|size| *size != 0.0);
    bent.then(|| std::array::from_fn(|k| std::array::from_fn(|j| sizes[k * n + j])))
}
