//! Numbers by which the rate response, the thrust and a velocity's lag are bent. They take part in fits once an effect
//! of the same is in, and in nothing that is written or reported.

use super::forms::{self, TAPS_S};
use super::numbers::{BEGIN, FORMS};
use crate::model::effects::{Card, CompactNumber, RateResponse, ResidualChannel, Role};

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

/// Whether an effect is about a velocity that comes late.
fn lags(card: &Card) -> bool {
    card.role == Role::VelocityLag
}

/// The numbers that bend what effects of `held` are about.
pub fn open(held: &[&'static Card]) -> impl Iterator<Item = usize> {
    let [response, thrust, velocity] = [responds, thrusts, lags].map(|about| held.iter().any(|card| about(card)));
    let spans = [(FORMS..THRUST, response), (THRUST..VELOCITY, thrust), (VELOCITY..BEGIN, velocity)];
    spans.into_iter().filter(|(_, is_open)| *is_open).flat_map(|(span, _)| span)
}

/// Where those of the thrust begin.
pub const THRUST: usize = FORMS + forms::RESPONSE;

/// Where that of the velocity's lag is.
pub const VELOCITY: usize = THRUST + forms::THRUST;

/// By how much the thrust is bent by each of [`forms::thrust`], m/s2.
pub fn thrust(x: &[f64]) -> Option<&[f64]> {
    let sizes = &x[THRUST..VELOCITY];
    sizes.iter().any(|size| *size != 0.0).then_some(sizes)
}

/// By how much each axis' rate is bent at each of [`TAPS_S`], s.
pub fn taps(x: &[f64]) -> Option<[[f64; TAPS_S.len()]; 3]> {
    let n = TAPS_S.len();
    let sizes = &x[FORMS..THRUST];
    let bent = sizes.iter().any(|size| *size != 0.0);
    bent.then(|| std::array::from_fn(|k| std::array::from_fn(|j| sizes[k * n + j])))
}
