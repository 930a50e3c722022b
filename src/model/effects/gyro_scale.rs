//! A gyro that reads too much or too little, each axis by its own share: w (1 + scale).

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};

pub struct GyroScale;

const fn share(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "1", low: -0.1, high: 0.1, typical: [0.005, 0.03] }
}

impl Effect for GyroScale {
    const CARD: Card = Card {
        id: "gyro_scale",
        name: "gyro scale",
        sentence: "the gyro tells more or less than the vehicle turns, by a share of it on each axis",
        kind: EffectKind::Sensor,
        parameters: &[share("x"), share("y"), share("z")],
        writes: &[Quantity::Gyro, Quantity::Integrated],
        channels: &[ResidualChannel::Rate, ResidualChannel::Turn],
        signature: "the integrated gyro is off by a share of every turn of the attitude",
        rivals: &["rate_expo", "clock_skew"],
        manoeuvre: ("whole flips and spins on every axis", &["roll-flip", "pitch-flip", "yaw-spin"]),
        shown: Some(|k, _| {
            let scale = (k[0] + k[1] + k[2]) / 3.0;
            vec![("x", k[0], "1"), ("y", k[1], "1"), ("z", k[2], "1"), ("scale", scale, "1")]
        }),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        for (rate, scale) in sensed.rates.iter_mut().zip(k) {
            *rate *= 1.0 + scale;
        }
    }
}
