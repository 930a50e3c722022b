//! Sensors answer to kinematics: what attitude and velocity, against the integrated gyro and accelerometer, say of a
//! sensor's error without any model of the vehicle.

use super::alone::Alone;
use crate::insight::criteria::unseen::{KINEMATIC_DEVIATIONS, KINEMATIC_SHARE};
use crate::insight::diagnose::fitting::agreement::kinematic;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::{self, Card, EffectKind, ResidualChannel};

/// Effects of sensors that the fit holds and that kinematics by themselves do not show.
pub fn missing(fitted: &FittedSelection) -> Vec<&'static Card> {
    let seen = |card: &Card| [ResidualChannel::Turn, ResidualChannel::Push].iter().any(|c| card.channels.contains(c));
    let sensed = |card: &&Card| card.kind == EffectKind::Sensor && seen(card);
    let mut cards: Vec<&'static Card> = effects::cards().filter(sensed).collect();
    let numbers: Vec<usize> = cards.iter().flat_map(|card| span(card)).collect();
    let Some(alone) = Alone::of(fitted, |k| numbers.contains(&k), kinematic, &[]) else { return Vec::new() };
    let short = |(share, sd): (f64, f64)| share + KINEMATIC_DEVIATIONS.get() * sd < KINEMATIC_SHARE.get();
    cards.retain(|card| alone.share(card).is_some_and(short));
    cards
}
