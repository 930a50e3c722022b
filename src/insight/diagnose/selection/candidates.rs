//! Directions in which the prediction could change, and by how much each changes it.

use crate::insight::criteria::evident::SKEW_TRIED;
use crate::insight::diagnose::fitting::fit::FitPoint;
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::numbers::{BEGIN, DISCHARGE, span};
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::model::effects::{self, Card, EffectKind, Quantity, Role, are_rivals};
use rayon::prelude::*;

/// What others are computed from: a cause that changes one of these changes what other causes would do.
const UPSTREAM: [Quantity; 5] =
    [Quantity::RateCommand, Quantity::ThrustCommand, Quantity::BodyRates, Quantity::Voltage, Quantity::GyroTime];

/// A way to begin with an effect: numbers and their values.
#[derive(Clone, Debug)]
pub struct Direction {
    pub card: &'static Card,
    pub start: Vec<(usize, f64)>,
}

/// A direction with the change of the prediction that it makes, plain and whitened.
pub struct Candidate {
    pub direction: Direction,
    pub change: ChannelValues,
    pub white: ChannelValues,
}

impl Candidate {
    pub fn card(&self) -> &'static Card {
        self.direction.card
    }
}

/// The numbers of the compact model and of constant sensor errors that the flights tell anything about.
pub fn base_numbers(problem: &Problem) -> Vec<usize> {
    let errors = [Role::ConstantError, Role::OdometryLate];
    let biases = errors.into_iter().flat_map(effects::acting).flat_map(span);
    let volts = BEGIN..BEGIN + problem.records.len();
    // Constant errors and clocks are each set's own, and how far its packs fall, which is as they are flown.
    let contrast = problem.contrast.as_ref();
    let each = errors.into_iter().flat_map(effects::acting).flat_map(span).chain([DISCHARGE]);
    let each = each.filter_map(|k| contrast?.of(k));
    let each = each.chain(own_differences(problem));
    let own = of_base_effects(problem);
    let mut all: Vec<usize> = (0..=DISCHARGE).chain(biases).chain(volts).chain(each).chain(own).collect();
    all.sort_unstable();
    all.dedup();
    let state = problem.predict(&problem.model.base);
    all.retain(|&k| problem.model.numbers[k].high > problem.model.numbers[k].low);
    all.retain(|&k| !problem.slope(&state, &problem.model.base, k).iter().all(Vec::is_empty));
    all
}

/// Numbers of the effects that the base vehicle has.
fn of_base_effects(problem: &Problem) -> impl Iterator<Item = usize> {
    effects::cards().flat_map(span).filter(|&k| problem.model.base[k] != 0.0)
}

/// Differences of those: what was given is one set's, and the other may lack it.
pub fn own_differences(problem: &Problem) -> impl Iterator<Item = usize> {
    of_base_effects(problem).filter_map(|k| problem.contrast.as_ref()?.of(k))
}

/// Ways to begin with an effect: one size where it is linear, several where a large one looks unlike a small one.
pub fn directions(card: &'static Card) -> Vec<Direction> {
    let at = span(card);
    let sizes = |i: usize| {
        let [small, large] = card.parameters[i].typical;
        [small, (small * large).sqrt(), large]
    };
    let numbers: Vec<usize> = at.collect();
    if let Some(shape) = card.shape {
        let [small, _, large] = sizes(shape);
        let grid = (0..4).map(|i| small * (large / small).powf(f64::from(i) / 3.0));
        let main = 1 - shape;
        return grid
            .map(|tau| Direction { card, start: vec![(numbers[main], sizes(main)[1]), (numbers[shape], tau)] })
            .collect();
    }
    if card.parameters.len() > 1 {
        let each = numbers.iter().enumerate().filter(|(i, _)| !card.forms.contains(i));
        return each.map(|(i, &k)| Direction { card, start: vec![(k, sizes(i)[0])] }).collect();
    }
    let signs: &[f64] = if card.parameters[0].low < 0.0 { &[1.0, -1.0] } else { &[1.0] };
    let shifts = card.nonlinear || matches!(card.kind, EffectKind::Timing | EffectKind::Sensor);
    let wanted = if shifts { 4 - signs.len() } else { 1 };
    let sizes = sizes(0).into_iter().take(wanted);
    sizes
        .flat_map(|s| signs.iter().map(move |sign| sign * s))
        .map(|s| Direction { card, start: vec![(numbers[0], s)] })
        .collect()
}

/// Candidates: effects whose mean can be seen, that the base does not already hold.
pub fn causes(problem: &Problem) -> Vec<&'static Card> {
    let in_base = |card: &Card| span(card).any(|k| problem.model.base[k] != 0.0);
    let one_clock = problem.records.iter().all(|r| r.one_clock);
    let can_be_tried = |card: &&Card| match card.role {
        // Found in the variance, and in every fit.
        Role::RandomForce | Role::ConstantError | Role::OdometryLate => false,
        // Told from a delay of all commands afterwards.
        Role::ImuLate => false,
        Role::ClockFast => !one_clock,
        _ => true,
    };
    effects::cards().filter(can_be_tried).filter(|card| !in_base(card)).collect()
}

/// Candidates in all directions; those that change nothing are left out.
pub fn candidates(problem: &Problem, whitener: &Whitener, point: &FitPoint, cards: &[&'static Card]) -> Vec<Candidate> {
    let mut all: Vec<Direction> = cards.iter().flat_map(|card| directions(card)).collect();
    if let Some(card) = cards.iter().find(|card| card.role == Role::ClockFast)
        && let Some(skew) = crate::insight::diagnose::fitting::skew::estimate(problem, &point.state, &point.residual)
        && skew.abs() > SKEW_TRIED.get() * card.parameters[0].typical[0]
    {
        // Nothing else would come near.
        all.retain(|d| d.card.id != card.id);
        all.push(Direction { card, start: vec![(span(card).start, skew)] });
    }
    let one = |d: Direction| {
        let change = problem.secant(&point.state, &point.x, &d.start, 1.0);
        let finite = change.iter().flatten().all(|x| x.is_finite());
        let white = whitener.apply(&change, &problem.rows);
        (finite && !change.iter().all(Vec::is_empty)).then_some(Candidate { direction: d, change, white })
    };
    all.into_par_iter().filter_map(one).collect()
}

/// The candidates after the last of `held` was added: recomputed where it moved in time or in voltage what they change,
/// and of the causes that were tied with it; else as they were.
pub fn renewed(
    problem: &Problem,
    whitener: &Whitener,
    point: &FitPoint,
    held: &[&'static Card],
    tied: &[(&'static Card, f64)],
    mut found: Vec<Candidate>,
) -> Vec<Candidate> {
    let Some(last) = held.last() else { return found };
    found.retain(|c| held.iter().all(|h| h.id != c.card().id));
    let of = |card: &Card| span(card).map(|k| &problem.model.numbers[k]);
    let early = of(last).any(|n| n.writes.any(&UPSTREAM));
    let (rates, forces) = (of(last).any(|n| n.rates), of(last).any(|n| n.forces));
    let stale = |c: &Candidate| {
        early && of(c.card()).any(|n| rates && n.rates || forces && n.forces)
            || tied.iter().any(|(card, _)| card.id == c.card().id)
            || are_rivals(last, c.card())
    };
    found.par_iter_mut().filter(|c| stale(c)).for_each(|c| {
        let change = problem.secant(&point.state, &point.x, &c.direction.start, 1.0);
        if change.iter().flatten().all(|x| x.is_finite()) {
            c.white = whitener.apply(&change, &problem.rows);
            c.change = change;
        }
    });
    found
}
