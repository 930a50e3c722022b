//! Thrust that fades over a flight as the motors warm: f_T is scaled by 1 - k t / 300 s.

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

/// Time of flight that the parameter speaks of, s.
const FULL_S: f64 = 300.0;

impl Effect for It {
    const CARD: Card = Card {
        id: "thrust_fade",
        name: "fading thrust",
        sentence: "the same throttle lifts less at the end of a flight, whatever the voltage",
        kind: Kind::Thrust,
        parameters: &[Parameter { name: "k", unit: "1", low: 0.0, high: 0.25, typical: [0.02, 0.08] }],
        channels: &[Channel::Force],
        signature: "vertical specific force falls in proportion to the time in the air",
        rivals: &["voltage_compensation"],
        manoeuvre: ("the same punches at the start and at the end, on two packs", &["punch", "throttle-steps", "climb"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        flow.lift = flow.lift * (R::one() - k[0] * flow.elapsed * R::of(1.0 / FULL_S));
    }
}
