//! An accelerometer that reads too much or too little, each axis by its own share: f (1 + scale).

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};

pub struct AccelScale;

const fn share(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "1", low: -0.1, high: 0.1, typical: [0.005, 0.03] }
}

impl Effect for AccelScale {
    const CARD: Card = Card {
        id: "accel_scale",
        name: "accelerometer scale",
        sentence: "the accelerometer tells more or less than the vehicle feels, by a share of it on each axis",
        kind: EffectKind::Sensor,
        parameters: &[share("x"), share("y"), share("z")],
        writes: &[Quantity::Accelerometer, Quantity::Integrated],
        channels: &[ResidualChannel::Force, ResidualChannel::Push],
        signature: "specific force is off by a share that the change of velocity does not know of",
        rivals: &["mass_or_density", "accel_bias", "vibration_rectification"],
        manoeuvre: ("none to full thrust in many attitudes", &["punch", "chop", "ramp-up", "roll-flip"]),
        shown: Some(|k, _| {
            let scale = (k[0] + k[1] + k[2]) / 3.0;
            vec![("x", k[0], "1"), ("y", k[1], "1"), ("z", k[2], "1"), ("scale", scale, "1")]
        }),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        for (force, scale) in sensed.force.iter_mut().zip(k) {
            *force *= 1.0 + scale;
        }
    }
}
