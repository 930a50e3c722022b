//! What may differ between two sets of flights of one vehicle: numbers of the compact model, and effects.

use crate::insight::criteria::Criterion;
use crate::insight::criteria::changed::{
    CHANGED_DISCHARGE, CHANGED_DRAG, CHANGED_RATE, CHANGED_THRUST, CHANGED_TIME_CONSTANT,
};
use crate::insight::diagnose::fitting::size::is_bounded;
use crate::insight::diagnose::prediction::contrast::Contrast;
use crate::insight::diagnose::prediction::numbers::{DISCHARGE, DRAG, MAX_RATE, TAU, THRUST, span};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::candidates::base_numbers;
use crate::model::effects::{self, Card, CompactNumber, EffectKind, Role};
use std::ops::Range;

/// Something that may differ.
#[derive(Clone, Debug)]
pub struct Suspect {
    pub id: &'static str,
    pub name: &'static str,
    pub sentence: &'static str,
    /// The effect that it is; none of a number of the compact model.
    pub card: Option<&'static Card>,
    /// Numbers of the vehicle that it is about, and the share of them that matters, of the compact model.
    pub numbers: Range<usize>,
    pub matters: f64,
    /// Differences of those numbers.
    pub own: Vec<usize>,
}

/// The difference of a suspect, found.
#[derive(Clone, Debug)]
pub struct FoundDifference {
    /// Place among the suspects.
    pub suspect: usize,
    /// Places of what these flights do not tell from it.
    pub ties: Vec<usize>,
}

/// Id, name, sentence, numbers and share that matters.
type Workshop = (&'static str, &'static str, &'static str, Range<usize>, &'static Criterion);

/// Numbers of the compact model that a workshop changes.
fn compact() -> [Workshop; 7] {
    let tau = TAU.start;
    [
        (
            "thrust",
            "thrust over mass",
            "the same throttle pushes by another share: other propellers or motors, another mass",
            THRUST,
            &CHANGED_THRUST,
        ),
        ("drag", "drag", "the air brakes it more or less: other parts outside", DRAG, &CHANGED_DRAG),
        (
            "thrust_response",
            "response of the thrust",
            "thrust follows its command more slowly or quickly: motors, propellers, their controllers",
            tau + 3..tau + 4,
            &CHANGED_TIME_CONSTANT,
        ),
        (
            "rate_response",
            "response of roll and pitch",
            "roll and pitch follow the sticks more slowly or quickly: gains, filters, inertia",
            tau..tau + 2,
            &CHANGED_TIME_CONSTANT,
        ),
        (
            "yaw_response",
            "response of yaw",
            "yaw follows the stick more slowly or quickly: gains, filters, inertia",
            tau + 2..tau + 3,
            &CHANGED_TIME_CONSTANT,
        ),
        (
            "full_stick_rates",
            "full-stick rates",
            "full sticks ask for other rates: another rate profile",
            MAX_RATE,
            &CHANGED_RATE,
        ),
        (
            "discharge",
            "discharge of the pack",
            "the voltage falls faster or more slowly: another pack, or an older one",
            DISCHARGE..DISCHARGE + 1,
            &CHANGED_DISCHARGE,
        ),
    ]
}

/// Whether an effect may differ: its mean shows, and it is no accident of one log.
fn can_differ(card: &Card, one_clock: bool) -> bool {
    match card.role {
        Role::RandomForce | Role::OdometryLate | Role::ImuLate | Role::CommandsLost => false,
        Role::ClockFast => !one_clock,
        _ => true,
    }
}

/// All suspects that the flights of `problem` tell anything about; none where it has no contrast.
pub fn known(problem: &Problem) -> Vec<Suspect> {
    let Some(contrast) = &problem.contrast else { return Vec::new() };
    let told = base_numbers(problem);
    let one_clock = problem.records.iter().all(|r| r.one_clock);
    let numbers = compact().into_iter().filter(|(.., numbers, _)| numbers.clone().any(|k| told.contains(&k)));
    let numbers = numbers.map(|(id, name, sentence, numbers, matters)| {
        let own = differences(None, &numbers, contrast);
        Suspect { id, name, sentence, card: None, numbers, matters: matters.get(), own }
    });
    let cards = effects::cards().filter(|card| can_differ(card, one_clock)).map(|card| Suspect {
        id: card.id,
        name: card.name,
        sentence: card.sentence,
        card: Some(card),
        numbers: span(card),
        matters: 0.0,
        own: differences(Some(card), &span(card), contrast),
    });
    numbers.chain(cards).collect()
}

/// With the differences of its sizes. The shape of an effect is the vehicle's, before and after.
fn differences(card: Option<&Card>, numbers: &Range<usize>, contrast: &Contrast) -> Vec<usize> {
    let shape = card.and_then(|card| card.shape).map(|i| numbers.start + i);
    let mut own: Vec<usize> = numbers.clone().filter(|k| Some(*k) != shape).filter_map(|k| contrast.of(k)).collect();
    own.dedup();
    own
}

impl Suspect {
    /// Whether the compact model takes it up where both sets have it: then only the difference can be told.
    pub fn is_absorbed(&self) -> bool {
        let both_ways = |card: &Card| card.parameters[0].low < 0.0;
        let by_thrust = |card: &Card| card.absorbed_by.contains(&CompactNumber::Thrust) && both_ways(card);
        self.card.is_some_and(|card| card.about_full || by_thrust(card))
    }

    /// Whether it is an effect that is so before or after, at the numbers `x`: in the first flight or the last.
    pub fn in_a_set(&self, problem: &Problem, x: &[f64], is_so: impl Fn(&'static Card, &[f64]) -> bool) -> bool {
        let flights = [0, problem.records.len() - 1];
        self.card.is_some_and(|card| flights.into_iter().any(|f| is_so(card, &problem.numbers(f, x))))
    }

    /// Whether it ends at a bound of its range before or after: then it stands in for something else.
    pub fn is_bounded(&self, problem: &Problem, x: &[f64]) -> bool {
        self.in_a_set(problem, x, |card, x| is_bounded(problem, card, x))
    }

    /// How plain an answer it is, 0 the plainest: a number of the compact model, another cause in the vehicle, one in
    /// its sensors and their clocks.
    pub fn plainness(&self) -> u8 {
        match self.card.map(|card| card.kind) {
            None => 0,
            Some(EffectKind::Sensor) => 2,
            Some(_) => 1,
        }
    }

    /// Numbers of the vehicle that have to be known beside the difference.
    pub fn common(&self) -> impl Iterator<Item = usize> {
        let known = self.card.is_some() && !self.is_absorbed();
        self.numbers.clone().filter(move |_| known)
    }
}
