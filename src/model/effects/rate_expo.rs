//! Curved stick response: a becomes (1 - e) a + e a^3.

use super::{Card, CommandSetpoint, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct RateExpo;

impl Effect for RateExpo {
    const CARD: Card = Card {
        id: "rate_expo",
        name: "expo on the rates",
        sentence: "half a stick gives less than half of the full rate, though full stick gives all of it",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter { name: "e", unit: "1", low: -0.5, high: 1.0, typical: [0.05, 0.5] }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        negative: "large turns fall short, as where motors are at their limits: no stick need be curved",
        signature: "the settled rate is a curve of the stick, the same at every speed of the stick",
        rivals: &["rate_slew_limit", "gyro_scale"],
        manoeuvre: ("steps of several sizes, held until the rate settles", &["roll-steps", "pitch-steps", "yaw-steps"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn setpoint<R: Real>(k: &[R], setpoint: &mut CommandSetpoint<R>) {
        for i in 0..3 {
            let a = setpoint.command[i];
            setpoint.command[i] = k[0].mul_add(a * a * a - a, a);
        }
    }
}
