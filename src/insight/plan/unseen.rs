//! Where nothing is tied: effects that the flights so far would not have shown because too little was flown.

use super::causes::{Cause, Question};
use crate::insight::diagnose::Diagnosed;
use crate::insight::diagnose::selection::candidates::{causes, directions};
use crate::model::effects::Card;

/// Whether each of them is there, at a size between small and large; none where all would have shown.
pub fn question(diagnosed: &Diagnosed) -> Option<Question> {
    let (problem, selection) = (&diagnosed.problem, &diagnosed.selection);
    let listed = |card: &&&'static Card| diagnosed.diagnosis.not_detectable.iter().any(|n| n.effect == card.id);
    let little = |card: &&&'static Card| {
        let reach = selection.reach.iter().find(|r| r.card.id == card.id);
        reach.is_none_or(|r| !r.absorbed() && r.beyond())
    };
    let known = causes(problem);
    let cards = known.iter().filter(listed).filter(little);
    let present = |card: &&'static Card| {
        let mut x = selection.point.x.clone();
        let middle = directions(card).swap_remove(0).start;
        let [small, large] = card.parameters[0].typical;
        let scale = (large / small).sqrt();
        middle.iter().enumerate().for_each(|(i, &(k, size))| x[k] = if i == 0 { size * scale } else { size });
        Cause::new(Some(*card), x)
    };
    let absent = Cause::new(None, selection.point.x.clone());
    let all: Vec<Cause> = std::iter::once(absent).chain(cards.map(present)).collect();
    let pairs = super::causes::pairs(&all).into_iter().filter(|([i, _], _)| *i == 0).map(|([i, j], w)| ([j, i], w));
    let pairs: Vec<_> = pairs.collect();
    (!pairs.is_empty()).then(|| Question { pairs, causes: all, free: selection.point.free.clone() })
}
