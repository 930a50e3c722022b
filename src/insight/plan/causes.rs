//! Which causes are tied, each fitted in the place of the others.

use crate::insight::criteria::planned::PLANNED_MARGIN;
use crate::insight::criteria::replicated::AGREEING_STRETCHES;
use crate::insight::criteria::rival::TIE_DEVIATIONS;
use crate::insight::diagnose::Diagnosed;
use crate::insight::diagnose::fitting::unseen::deviations;
use crate::insight::diagnose::judgement::finding::{Finding, Status};
use crate::insight::diagnose::selection::candidates::{candidates, causes};
use crate::insight::diagnose::selection::rank::rank;
use crate::insight::diagnose::selection::trial::try_these;
use crate::model::effects::{self, Card};

/// A cause in the place of what is tied; none is that nothing is there.
#[derive(Clone, Debug)]
pub struct Cause {
    pub card: Option<&'static Card>,
    /// All numbers, fitted with it.
    pub x: Vec<f64>,
    /// Whitened squares of each stretch of time.
    cost: Vec<f64>,
}

impl Cause {
    pub fn new(card: Option<&'static Card>, x: Vec<f64>) -> Self {
        Cause { card, x, cost: Vec::new() }
    }
}

/// What the next flight is to tell.
pub struct Question {
    /// The likeliest first.
    pub causes: Vec<Cause>,
    /// Pairs of them, and how many standard deviations over stretches of time are wanted.
    pub pairs: Vec<([usize; 2], f64)>,
    /// Numbers that are free beside any cause.
    pub free: Vec<usize>,
}

/// The causes that are tied; none where every finding has a name of its own.
pub fn tied(diagnosed: &Diagnosed) -> Option<Question> {
    let (problem, selection) = (&diagnosed.problem, &diagnosed.selection);
    let known = causes(problem);
    let can_be_tried = |card: &Card| known.iter().any(|other| other.id == card.id);
    let added = |id: &str| selection.added.iter().any(|a| a.card.id == id);
    let open: Vec<&Finding> = diagnosed
        .diagnosis
        .findings
        .iter()
        .filter(|f| f.status != Status::Named && added(f.effect))
        .filter(|f| effects::card(f.effect).is_some_and(can_be_tried))
        .collect();
    if open.is_empty() {
        return None;
    }
    let rest = selection.without(problem, &open.iter().map(|f| f.effect).collect::<Vec<_>>());
    let mut cards: Vec<&'static Card> = Vec::new();
    for id in open.iter().flat_map(|f| possible(f)) {
        let card = effects::card(id).filter(|card| can_be_tried(card));
        let beside = rest.added.iter().any(|a| a.card.id == id) || cards.iter().any(|other| other.id == id);
        cards.extend(card.filter(|_| !beside));
    }
    let found = candidates(problem, &rest.whitener, &rest.point, &cards);
    let order = rank(problem, &rest.whitener, &rest.point, &found).order;
    let first = |card: &&'static Card| order.iter().map(|s| s.0).find(|&j| found[j].card().id == card.id);
    let which: Vec<usize> = cards.iter().filter_map(first).collect();
    let trials = try_these(problem, &rest.whitener, &rest.point, &found, &which);
    let fitted = trials.into_iter().map(|t| Cause { card: Some(t.card), x: t.point.x, cost: t.point.cost });
    // Where an effect is only suspected, it may not be there at all.
    let absent = Cause { card: None, x: rest.point.x.clone(), cost: rest.point.cost.clone() };
    let doubted = open.iter().any(|f| f.status == Status::Suspected);
    let mut all: Vec<Cause> = fitted.chain(doubted.then_some(absent)).collect();
    all.sort_by(|a, b| a.cost.iter().sum::<f64>().total_cmp(&b.cost.iter().sum()));
    let best = all.first()?.cost.clone();
    all.retain(|cause| cause.card.is_none() || !is_worse(cause, &best));
    let named = all.iter().filter(|cause| cause.card.is_some()).count();
    (named > 0 && all.len() > 1).then(|| Question { pairs: pairs(&all), causes: all, free: rest.point.free.clone() })
}

/// Findings without a name of their own that no fit beside the others holds.
pub fn left_out(diagnosed: &Diagnosed) -> Vec<&'static str> {
    let added = |id: &str| diagnosed.selection.added.iter().any(|a| a.card.id == id);
    let sets = diagnosed.diagnosis.findings.iter().filter(|f| f.status == Status::NamedSet);
    sets.filter(|f| !added(f.effect)).map(|f| f.effect).collect()
}

/// All that a finding may be, itself first.
fn possible(finding: &Finding) -> Vec<&'static str> {
    let rivals = if finding.status == Status::Suspected { &finding.rivals[..] } else { &[] };
    finding.members.iter().chain(rivals).copied().collect()
}

/// Whether the flights already tell a cause from the best.
fn is_worse(cause: &Cause, best: &[f64]) -> bool {
    let differences: Vec<f64> = cause.cost.iter().zip(best).map(|(a, b)| a - b).collect();
    deviations(&differences) > TIE_DEVIATIONS.get()
}

/// Every two of them, and what each has to be told by.
pub fn pairs(all: &[Cause]) -> Vec<([usize; 2], f64)> {
    let mut out = Vec::new();
    for i in 0..all.len() {
        for j in i + 1..all.len() {
            let numbers = match (all[i].card, all[j].card) {
                (Some(card), None) | (None, Some(card)) => Some(card.parameters.len()),
                _ => None,
            };
            // That it is there has to show in so many stretches for each of its numbers.
            let least = numbers.map_or(TIE_DEVIATIONS.get(), |n| (AGREEING_STRETCHES.get() * n as f64).sqrt());
            out.push(([i, j], PLANNED_MARGIN.get() + least));
        }
    }
    out
}
