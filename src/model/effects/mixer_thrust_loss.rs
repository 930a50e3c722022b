//! Thrust given up for turning: f_T is scaled by 1 - k times the sum of |command - response| over the axes.

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "mixer_thrust_loss",
        name: "thrust lost to the mixer",
        sentence: "the vehicle drops a little whenever it is jerked around",
        kind: Kind::Thrust,
        parameters: &[Parameter { name: "k", unit: "1", low: 0.0, high: 0.25, typical: [0.02, 0.1] }],
        channels: &[Channel::Force],
        signature: "vertical specific force dips while the rates are behind their commands",
        rivals: &["rate_thrust_coupling"],
        manoeuvre: ("flips and sharp steps at one throttle", &["roll-flip", "pitch-flip", "rate-steps"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        flow.lift = flow.lift * (R::one() - k[0] * flow.rate_error);
    }
}
