//! The compact model's numbers of each channel, and which of them flights move without need.

use super::channels::{FORCE, LIFT, OF_VEHICLE, VOLTAGE};
use super::fitted::FittedSelection;
use super::numbers::{DISCHARGE, DRAG, MAX_RATE, TAU, THRUST};
use super::pays::{Paid, pays};
use super::problem::Problem;
use super::select::Selection;
use super::unseen::parts;
use crate::insight::criteria::unseen::PAYS_DEVIATIONS;

/// The compact model's numbers of a channel: how a rate goes to its command, drag of an axis, thrust, discharge.
pub fn own(channel: usize) -> Vec<usize> {
    match channel {
        VOLTAGE => vec![DISCHARGE],
        LIFT => THRUST.collect(),
        _ if channel < FORCE => vec![TAU.start + channel, MAX_RATE.start + channel],
        _ => vec![DRAG.start + channel - FORCE],
    }
}

/// Those of all channels of its kind: rates, or forces with the voltage.
pub fn like(channel: usize) -> Vec<usize> {
    let rates = |k: &usize| (TAU.start..TAU.end - 1).contains(k) || MAX_RATE.contains(k);
    (0..=DISCHARGE).filter(|k| rates(k) == (channel < FORCE)).collect()
}

/// The fitted numbers, by channel, that need not move from the base vehicle's: on unseen flight it does not surely pay,
/// and most stretches speak against it. What a few stretches hold that is beyond the model, such as motors at their
/// limits, pulls at numbers that all others know.
pub fn unpaid(problem: &Problem, selection: &Selection) -> Vec<Vec<usize>> {
    let fitted = FittedSelection::new(problem, selection);
    let free = &selection.point.free;
    let fitted_of = |channel| -> Vec<usize> { own(channel).into_iter().filter(|k| free.contains(k)).collect() };
    let groups: Vec<Vec<usize>> = OF_VEHICLE.into_iter().map(fitted_of).filter(|group| !group.is_empty()).collect();
    let places = |group: &Vec<usize>| group.iter().filter_map(|k| free.iter().position(|f| f == k)).collect();
    let paid = pays(&fitted, &parts(problem), &groups.iter().map(places).collect::<Vec<_>>());
    let unneeded = |paid: &Paid| paid.whole < PAYS_DEVIATIONS.get() && paid.limited < 0.0;
    groups.into_iter().zip(paid).filter(|(_, paid)| unneeded(paid)).map(|(group, _)| group).collect()
}
