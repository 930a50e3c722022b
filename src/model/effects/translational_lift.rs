//! Thrust gained from fresh air: f_T += k v_h^2 (momentum theory).

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "translational_lift",
        name: "translational lift",
        sentence: "in fast level flight the vehicle carries itself on less throttle",
        kind: Kind::Thrust,
        parameters: &[Parameter { name: "k", unit: "1/m", low: 0.0, high: 0.08, typical: [0.003, 0.03] }],
        channels: &[Channel::Force],
        signature: "vertical specific force grows with the square of the speed across the rotors",
        rivals: &["body_lift"],
        manoeuvre: ("level passes from slow to fast", &["forward", "backward", "left", "right"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        let [x, y, _] = flow.velocity;
        flow.lift = k[0].mul_add(x.mul_add(x, y * y), flow.lift);
    }
}
