//! Numbers by which the rate response, the thrust, a velocity's lag and the drag are bent. They take part in fits once
//! an effect of the same is in, and in nothing that is written or reported.

use super::forms::{self, TAPS_S};
use super::numbers::{BEGIN, FORMS};
use crate::model::effects::{Card, CompactNumber, Quantity, RateResponse, ResidualChannel, Role};

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

/// Whether an effect is about a force that goes with the velocity.
pub fn brakes(card: &Card) -> bool {
    card.writes.contains(&Quantity::SpecificForce) && card.reads.contains(&Quantity::Velocity)
}

/// The numbers that bend the drag: not beside a cause that goes with the velocity, but in its place.
pub fn of_drag() -> impl Iterator<Item = usize> {
    DRAG..BEGIN
}

/// The numbers that bend what effects of `held` are about.
pub fn open(held: &[&'static Card]) -> impl Iterator<Item = usize> {
    let [response, thrust, velocity] = [responds, thrusts, lags].map(|about| held.iter().any(|card| about(card)));
    let spans = [(FORMS..THRUST, response), (THRUST..VELOCITY, thrust), (VELOCITY..DRAG, velocity)];
    spans.into_iter().filter(|(_, is_open)| *is_open).flat_map(|(span, _)| span)
}

/// Where those of the thrust begin.
pub const THRUST: usize = FORMS + forms::RESPONSE;

/// Where that of the velocity's lag is.
pub const VELOCITY: usize = THRUST + forms::THRUST;

/// Where those of the drag begin.
pub const DRAG: usize = VELOCITY + forms::VELOCITY;

/// By how much the drag is bent along each axis, 1/m.
pub fn drag(x: &[f64]) -> Option<[f64; forms::DRAG]> {
    let sizes: [f64; forms::DRAG] = std::array::from_fn(|k| x[DRAG + k]);
    sizes.iter().any(|size| *size != 0.0).then_some(sizes)
}

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
