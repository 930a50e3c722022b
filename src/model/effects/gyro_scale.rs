//! A gyro that reads too much or too little: w (1 + scale).

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};

pub struct GyroScale;

impl Effect for GyroScale {
    const CARD: Card = Card {
        id: "gyro_scale",
        name: "gyro scale",
        sentence: "the gyro tells more or less than the vehicle turns, by the same share",
        kind: EffectKind::Sensor,
        parameters: &[EffectParameter { name: "scale", unit: "1", low: -0.1, high: 0.1, typical: [0.005, 0.03] }],
        writes: &[Quantity::Gyro, Quantity::Integrated],
        channels: &[ResidualChannel::Rate, ResidualChannel::Turn],
        signature: "the integrated gyro is off by a share of every turn of the attitude",
        rivals: &["rate_expo", "clock_skew"],
        manoeuvre: ("whole flips and spins on every axis", &["roll-flip", "pitch-flip", "yaw-spin"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        sensed.rates = sensed.rates.map(|w| w * (1.0 + k[0]));
    }
}
