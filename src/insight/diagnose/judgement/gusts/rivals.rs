//! What may be gusts, or the other way round.

use crate::insight::criteria::chance::GUST_MEMORY_MOST_S;
use crate::insight::diagnose::judgement::finding::Finding;
use crate::model::effects::{self, Quantity, Role};

/// Whether these gusts last for so long that a wind which turns, or grows with height, leaves the same.
pub fn last_like_wind(gusts: &Finding) -> bool {
    gusts.has(Role::RandomForce) && gusts.parameters.get("tau").is_some_and(|tau| tau.value > GUST_MEMORY_MOST_S.get())
}

/// Whether gusts that push by so much, m/s after a second, may be what a finding is: of a drag by the square of the
/// speed moving air makes one that goes with the speed as well, which pushes less than the gusts themselves.
pub fn may_be(pushes: f64, finding: &Finding) -> bool {
    let flows = effects::card(finding.effect).is_some_and(|card| card.reads.contains(&Quantity::Velocity));
    flows && finding.impact < pushes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_air_brakes_less_than_it_pushes() {
        let pushing = |card, impact| Finding { impact, ..Finding::of(card) };
        let card = |flows| effects::MODEL.into_iter().find(|c| c.reads.contains(&Quantity::Velocity) == flows);
        let [drag, other] = [true, false].map(|flows| card(flows).expect("one"));
        assert!(may_be(0.17, &pushing(drag, 0.068)));
        assert!(!may_be(0.17, &pushing(drag, 0.46)), "more than moving air makes");
        assert!(!may_be(0.17, &pushing(other, 0.068)), "it does not go with the speed");
    }
}
