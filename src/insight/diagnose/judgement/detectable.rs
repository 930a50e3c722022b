//! What flights could show, whatever they do show: the size of each effect from which nine of ten such flights would
//! give it away, and tell it from its nearest rival.

use super::diagnosis::{Detectable, NotDetectable};
use super::finding::{Finding, Status};
use crate::insight::criteria::flown::NEAREST_LIKENESS;
use crate::insight::criteria::material::MATERIAL_SIZE;
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::lost::lost_commands;
use crate::model::effects::{self, Card, EffectKind, ResidualChannel, Role};

/// What the flights could show, and what not, and why; what is named of `findings` has shown, however little of it
/// would have.
pub fn judge(problem: &Problem, selection: &Selection, findings: &[Finding]) -> (Vec<Detectable>, Vec<NotDetectable>) {
    let (mut can, mut cannot) = (Vec::new(), Vec::new());
    for card in effects::cards() {
        let p = &card.parameters[0];
        let hidden =
            |why: String, smallest: Option<f64>| NotDetectable { effect: card.id, why, smallest, unit: p.unit };
        if span(card).any(|k| problem.model.base[k] != 0.0) {
            continue;
        }
        let Some(r) = selection.reach.iter().find(|r| r.card.id == card.id) else {
            if let Some(why) = lacking(problem, card) {
                cannot.push(hidden(why, None));
            } else if card.kind != EffectKind::Random && card.role != Role::ConstantError {
                cannot.push(hidden(format!("nothing flown would show it: {}", card.manoeuvre.0), None));
            }
            continue;
        };
        // What is less than that matters to nobody, and has no name.
        let least = MATERIAL_SIZE.get() * p.typical[0];
        // Lost commands are counted, and told from a delay by each of them.
        let counted = card.role == Role::CommandsLost;
        let seen = if counted { lost_commands(problem, selection).seen_from() } else { r.smallest };
        let smallest = seen.max(least);
        if r.behind {
            cannot.push(hidden(
                format!("what is fitted to these flights takes up most of it: {}", card.manoeuvre.0),
                None,
            ));
            continue;
        }
        if r.absorbed() {
            let why = "the compact model's own numbers take it up; only a drift against a known vehicle shows it";
            cannot.push(hidden(why.into(), None));
            continue;
        }
        let like = r.nearest.filter(|_| !counted);
        let likeness = like.map_or(0.0, |(_, likeness)| likeness);
        let told_apart = smallest / (1.0 - likeness * likeness).max(1e-6).sqrt();
        if smallest > p.typical[1] {
            cannot.push(hidden(format!("too little of it was flown: {}", card.manoeuvre.0), Some(smallest)));
            continue;
        }
        let nearest = like.filter(|n| n.1 > NEAREST_LIKENESS.get()).map(|n| n.0);
        can.push(Detectable {
            effect: card.id,
            smallest,
            told_apart,
            nearest,
            unit: p.unit,
            typical: p.typical,
            manoeuvre: card.manoeuvre.0,
        });
    }
    let named = |id: &str| findings.iter().any(|f| f.effect == id && f.status != Status::Suspected);
    cannot.retain(|n: &NotDetectable| !named(n.effect));
    (can, cannot)
}

/// What the logs lack to show an effect.
fn lacking(problem: &Problem, card: &Card) -> Option<String> {
    let any = |from: usize| !problem.rows[from].is_empty();
    let has = |channel: &ResidualChannel| match channel {
        ResidualChannel::Rate => any(0),
        ResidualChannel::Force => any(5),
        ResidualChannel::Turn => any(6),
        ResidualChannel::Push => any(9),
        ResidualChannel::Voltage => any(12),
    };
    let name = |channel: &ResidualChannel| match channel {
        ResidualChannel::Rate => "rate commands with the gyro",
        ResidualChannel::Force => "thrust commands with the accelerometer",
        ResidualChannel::Turn => "attitude",
        ResidualChannel::Push => "attitude and velocity",
        ResidualChannel::Voltage => "voltage",
    };
    if card.channels.iter().any(has) {
        let moves = problem.records.iter().any(|r| r.moves);
        return (!moves && matches!(card.kind, EffectKind::Drag | EffectKind::Thrust))
            .then(|| "the logs hold no velocity".into());
    }
    Some(format!("the logs hold no {}", card.channels.iter().map(name).collect::<Vec<_>>().join(" and no ")))
}
