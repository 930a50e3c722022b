//! The compact model's numbers of each channel, and which of them flights move without need.

use crate::insight::criteria::unseen::PAYS_DEVIATIONS;
use crate::insight::diagnose::fitting::unseen::parts;
use crate::insight::diagnose::judgement::pays::{Paid, pays};
use crate::insight::diagnose::prediction::channels::{FORCE, LIFT, OF_VEHICLE, VOLTAGE, kind};
use crate::insight::diagnose::prediction::numbers::{DISCHARGE, DRAG, MAX_RATE, TAU, THRUST, span};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::{Card, MODEL};

/// The compact model's numbers of a channel: how a rate goes to its command, drag of an axis, thrust with its time
/// constant, discharge.
pub fn own(channel: usize) -> Vec<usize> {
    match channel {
        VOLTAGE => vec![DISCHARGE],
        LIFT => THRUST.chain([TAU.end - 1, DRAG.end - 1]).collect(),
        _ if channel < FORCE => vec![TAU.start + channel, MAX_RATE.start + channel],
        _ => vec![DRAG.start + channel - FORCE],
    }
}

/// The base vehicle's numbers of all channels of its kind, rates or forces with the voltage: the compact model's, and
/// those of the effects that the base has.
pub fn like(problem: &Problem, channel: usize) -> Vec<usize> {
    let of_rates = |k: &usize| (TAU.start..TAU.end - 1).contains(k) || MAX_RATE.contains(k);
    let compact = (0..=DISCHARGE).filter(|k| of_rates(k) == (channel < FORCE));
    let about = |card: &&Card| card.channels.contains(&kind(channel));
    let had = MODEL.into_iter().filter(about).flat_map(span).filter(|&k| problem.model.base[k] != 0.0);
    compact.chain(had).collect()
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
