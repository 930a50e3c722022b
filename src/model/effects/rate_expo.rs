//! Curved stick response: a becomes (1 - e) a + e a^3.

use super::{Asked, Card, Channel, Effect, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "rate_expo",
        name: "expo on the rates",
        sentence: "half a stick gives less than half of the full rate, though full stick gives all of it",
        kind: Kind::Timing,
        parameters: &[Parameter { name: "e", unit: "1", low: -0.5, high: 1.0, typical: [0.05, 0.5] }],
        channels: &[Channel::Rate],
        signature: "the settled rate is a curve of the stick, the same at every speed of the stick",
        rivals: &["rate_slew_limit", "gyro_scale"],
        manoeuvre: ("steps of several sizes, held until the rate settles", &["roll-steps", "pitch-steps", "yaw-steps"]),
        shown: None,
    };

    #[inline(always)]
    fn ask<R: Real>(k: &[R], asked: &mut Asked<R>) {
        for i in 0..3 {
            let a = asked.command[i];
            asked.command[i] = k[0].mul_add(a * a * a - a, a);
        }
    }
}
