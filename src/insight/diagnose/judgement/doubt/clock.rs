//! A clock that runs fast shifts thrust as it shifts rates. Rates alone that come later and later have a response that
//! slows.

use super::alone::Alone;
use crate::insight::criteria::unseen::{KINEMATIC_DEVIATIONS, KINEMATIC_SHARE};
use crate::insight::diagnose::fitting::agreement::only;
use crate::insight::diagnose::prediction::channels::FORCE;
use crate::insight::diagnose::prediction::problem::ChannelValues;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::Card;

/// Whether the forces by themselves leave the skew `card` in doubt: they do not show it beyond chance, or less of it
/// than all channels together have.
pub fn is_unshown(fitted: &FittedSelection, card: &Card) -> bool {
    let forces = |values: &ChannelValues| only(values, FORCE..FORCE + 3);
    let unsure = |(share, sd): (f64, f64)| {
        let chance = KINEMATIC_DEVIATIONS.get() * sd;
        share < chance || share + chance < KINEMATIC_SHARE.get()
    };
    Alone::of(fitted, |_| true, forces, &[]).and_then(|alone| alone.share(card)).is_some_and(unsure)
}
