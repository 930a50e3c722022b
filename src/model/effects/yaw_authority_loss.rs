//! Yaw that fades where the motors saturate: the yaw command is scaled by 1 - k sat(s), sat rising from 0 at s = 0.8 to 1 at 1.

use super::{Asked, Card, Channel, Effect, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "yaw_authority_loss",
        name: "loss of yaw authority",
        sentence: "near full throttle the vehicle yaws less than asked",
        kind: Kind::Timing,
        parameters: &[Parameter { name: "k", unit: "1", low: 0.0, high: 1.0, typical: [0.1, 0.6] }],
        channels: &[Channel::Rate],
        signature: "the yaw rate falls short only where throttle and yaw command are both large",
        rivals: &[],
        manoeuvre: ("yaw steps at full throttle", &["punch-turns"]),
        shown: None,
    };

    #[inline(always)]
    fn ask<R: Real>(k: &[R], asked: &mut Asked<R>) {
        let saturated = ((asked.throttle - R::of(0.8)) * R::of(5.0)).clamp(R::zero(), R::one());
        asked.command[2] = asked.command[2] * (R::one() - k[0] * saturated);
    }
}
