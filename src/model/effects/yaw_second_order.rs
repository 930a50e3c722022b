//! Second-order response of yaw alone: T2 w'' + tau w' + w = w_sp. Yaw is turned by the rotors' reaction torque, which
//! is weak: a loop that holds it tightly rings where those of roll and pitch do not.
//! Betaflight's default gains, rehearsed on a vehicle of 1 kg, ring at 3 Hz with a damping of 0.2.

use super::{
    Actuator, Card, ControllerPart, Effect, EffectKind, EffectParameter, Quantity, RateResponse, ResidualChannel,
};
use crate::base::lane::Real;

pub struct YawSecondOrder;

impl Effect for YawSecondOrder {
    const CARD: Card = Card {
        id: "yaw_second_order",
        name: "second-order yaw response",
        sentence: "yaw overshoots and swings after a stick step, roll and pitch do not",
        kind: EffectKind::Timing,
        // wn of 60 to 15 rad/s.
        parameters: &[EffectParameter { name: "T2", unit: "s2", low: 0.0, high: 2e-2, typical: [2.8e-4, 4.4e-3] }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        response: RateResponse::SecondOrder,
        apart_from: &["rate_delay", "rate_second_order"],
        controller: Some(ControllerPart::YawInertia),
        signature: "the gyro's yaw rings after steps, at one frequency",
        rivals: &["yaw_delay", "rate_second_order"],
        manoeuvre: ("sharp yaw steps and doublets, then hands off", &["yaw-steps", "yaw-doublets"]),
        shown: Some(|k, [_, _, tau, _]| {
            let wn = 1.0 / k[0].max(1e-9).sqrt();
            vec![("wn", wn, "rad/s"), ("zeta", 0.5 * tau * wn, "1")]
        }),
        ..Card::BLANK
    };

    #[inline(always)]
    fn actuator<R: Real>(k: &[R], actuator: &mut Actuator<R>) {
        actuator.inertia[2] = actuator.inertia[2] + k[0];
    }
}
