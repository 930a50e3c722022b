//! An accelerometer that reads too much or too little: f (1 + scale).

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};

pub struct AccelScale;

impl Effect for AccelScale {
    const CARD: Card = Card {
        id: "accel_scale",
        name: "accelerometer scale",
        sentence: "the accelerometer tells more or less than the vehicle feels, by the same share",
        kind: EffectKind::Sensor,
        parameters: &[EffectParameter { name: "scale", unit: "1", low: -0.1, high: 0.1, typical: [0.005, 0.03] }],
        writes: &[Quantity::Accelerometer, Quantity::Integrated],
        channels: &[ResidualChannel::Force, ResidualChannel::Push],
        signature: "specific force is off by a share that the change of velocity does not know of",
        rivals: &["mass_or_density", "accel_bias", "vibration_rectification"],
        manoeuvre: ("none to full thrust in many attitudes", &["punch", "chop", "ramp-up", "roll-flip"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        sensed.force = sensed.force.map(|f| f * (1.0 + k[0]));
    }
}
