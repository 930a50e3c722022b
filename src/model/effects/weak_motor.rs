//! A motor or propeller that gives less than the others: w += b s.

use super::{BodyRates, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Role};
use crate::base::lane::Real;

pub struct WeakMotor;

const fn rate(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "rad/s", low: -1.5, high: 1.5, typical: [0.05, 0.6] }
}

impl Effect for WeakMotor {
    const CARD: Card = Card {
        id: "weak_motor",
        name: "weak motor",
        sentence: "the vehicle leans and turns by itself, the more the higher the throttle",
        kind: EffectKind::Timing,
        parameters: &[rate("bx"), rate("by"), rate("bz")],
        writes: &[Quantity::BodyRates],
        reads: &[Quantity::ThrustCommand],
        channels: &[ResidualChannel::Rate],
        role: Role::OneMotor,
        signature: "the mean rate without command grows in proportion to the throttle",
        rivals: &["gyro_bias"],
        manoeuvre: ("slow throttle sweeps with the other sticks centred", &["ramp-up", "ramp-down", "punch"]),
        shown: Some(|k, _| {
            let b = (k[0].abs() + k[1].abs() + k[2].abs()) / 3.0;
            vec![("bx", k[0], "rad/s"), ("by", k[1], "rad/s"), ("bz", k[2], "rad/s"), ("b", b, "rad/s")]
        }),
        ..Card::BLANK
    };

    #[inline(always)]
    fn body_rates<R: Real>(k: &[R], body: &mut BodyRates<R>) {
        for (rate, b) in body.rates.iter_mut().zip(k) {
            *rate = b.mul_add(body.throttle, *rate);
        }
    }
}
