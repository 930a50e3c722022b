//! An accelerometer that is off by a constant: f + b.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Role, Sensed};

pub struct AccelBias;

const fn bias(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "m/s2", low: -1.2, high: 1.2, typical: [0.05, 0.4] }
}

impl Effect for AccelBias {
    const CARD: Card = Card {
        id: "accel_bias",
        name: "accelerometer bias",
        sentence: "the accelerometer shows a push that is not there",
        kind: EffectKind::Sensor,
        parameters: &[bias("x"), bias("y"), bias("z")],
        writes: &[Quantity::Accelerometer, Quantity::Integrated],
        channels: &[ResidualChannel::Force, ResidualChannel::Push],
        role: Role::ConstantError,
        signature: "specific force is off by a constant in the body that the change of velocity does not know of",
        rivals: &["accel_scale", "imu_misalignment", "steady_wind", "vibration_rectification"],
        manoeuvre: (
            "many attitudes, and the same leg both ways",
            &["circle", "roll-flip", "pitch-flip", "forward", "backward"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        (0..3).for_each(|i| sensed.force[i] += k[i]);
    }
}
