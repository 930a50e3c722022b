//! A rival that was tried beside what is named, and of which nothing is known there, may be the change as well.

use super::change::Change;
use crate::insight::diagnose::judgement::finding::Status;
use crate::model::effects::{self, Card, are_rivals};

/// Makes what is named a set with such rivals.
pub fn tell(changes: &mut [Change]) {
    let card = |c: &Change| effects::card(c.cause);
    let suspected = changes.iter().filter(|c| c.status == Status::Suspected);
    let untold: Vec<&'static Card> = suspected.filter_map(|c| card(c).filter(|card| is_untold(card, c))).collect();
    for change in changes.iter_mut().filter(|c| c.status != Status::Suspected) {
        let Some(own) = card(change) else { continue };
        let may_be = |rival: &&&Card| are_rivals(own, rival) && !change.members.contains(&rival.id);
        let rivals: Vec<&str> = untold.iter().filter(may_be).map(|rival| rival.id).collect();
        change.or(rivals);
    }
}

/// Whether the interval of each size is wider to either side than the size itself usually is.
fn is_untold(card: &Card, change: &Change) -> bool {
    let wide = |p: &effects::EffectParameter| {
        change.difference.get(p.name).is_some_and(|d| 0.5 * (d.high - d.low) > p.typical[1])
    };
    card.sizes().all(|(_, p)| wide(p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::insight::diagnose::judgement::finding::Value;

    #[test]
    fn a_rival_of_unknown_size_may_be_it() {
        let (card, rival) = effects::cards()
            .filter(|card| card.sizes().count() == 1)
            .find_map(|card| Some((effects::card(card.rivals.first()?)?, card)))
            .expect("two that look alike");
        let (_, size) = rival.sizes().next().expect("a size");
        let members = |sd: f64| {
            let named = Change::sample(card.id, 1.0, "1");
            let mut suspected = Change::sample(rival.id, 0.0, size.unit);
            suspected.status = Status::Suspected;
            suspected.difference = [(size.name.to_string(), Value::measured(0.0, sd, size.unit))].into();
            let mut changes = [named, suspected];
            tell(&mut changes);
            assert_eq!(changes[0].members.len() > 1, changes[0].status == Status::NamedSet);
            changes[0].members.len()
        };
        assert_eq!(members(size.typical[1]), 2);
        assert_eq!(members(0.1 * size.typical[1]), 1, "it is known to be none");
    }
}
