//! Second-order response of the body rates: T2 w'' + tau w' + w = w_sp, with T2 = 1 / wn^2 and tau = 2 zeta / wn.

use super::{
    Actuator, Card, ControllerPart, Effect, EffectKind, EffectParameter, Quantity, RateResponse, ResidualChannel,
};
use crate::base::lane::Real;

pub struct RateSecondOrder;

impl Effect for RateSecondOrder {
    const CARD: Card = Card {
        id: "rate_second_order",
        name: "second-order rate response",
        sentence: "the rates overshoot and ring after a stick step instead of creeping to their goal",
        kind: EffectKind::Timing,
        // wn of 150 to 60 rad/s.
        parameters: &[EffectParameter { name: "T2", unit: "s2", low: 0.0, high: 2e-3, typical: [4.4e-5, 2.8e-4] }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        response: RateResponse::SecondOrder,
        controller: Some(ControllerPart::Inertia),
        signature: "the gyro rings after steps, at one frequency",
        rivals: &["rate_delay", "rate_slew_limit"],
        manoeuvre: (
            "sharp steps and fast stick doublets, then hands off",
            &["rate-steps", "roll-doublets", "pitch-doublets"],
        ),
        shown: Some(|k, [tau, ..]| {
            let wn = 1.0 / k[0].max(1e-9).sqrt();
            vec![("wn", wn, "rad/s"), ("zeta", 0.5 * tau * wn, "1")]
        }),
        ..Card::BLANK
    };

    #[inline(always)]
    fn actuator<R: Real>(k: &[R], actuator: &mut Actuator<R>) {
        actuator.inertia = actuator.inertia.map(|own| own + k[0]);
    }
}
