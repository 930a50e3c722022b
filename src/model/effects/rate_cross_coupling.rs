//! Rolling pitches, and pitching rolls: w_x += k_xy w_y, w_y += k_yx w_x.

use super::{BodyRates, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct RateCrossCoupling;

const fn share(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "1", low: -0.3, high: 0.3, typical: [0.01, 0.1] }
}

impl Effect for RateCrossCoupling {
    const CARD: Card = Card {
        id: "rate_cross_coupling",
        name: "coupling of roll and pitch",
        sentence: "a pure roll also pitches a little, or a pure pitch rolls",
        kind: EffectKind::Timing,
        parameters: &[share("kxy"), share("kyx")],
        writes: &[Quantity::BodyRates],
        channels: &[ResidualChannel::Rate],
        signature: "the off-axis rate follows the other axis in proportion, in gyro and attitude alike",
        rivals: &["imu_misalignment", "gyroscopic_coupling"],
        manoeuvre: (
            "doublets and flips on one axis at a time",
            &["roll-doublets", "pitch-doublets", "roll-flip", "pitch-flip"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn body_rates<R: Real>(k: &[R], body: &mut BodyRates<R>) {
        let [x, y, z] = body.rates;
        body.rates = [k[0].mul_add(y, x), k[1].mul_add(x, y), z];
    }
}
