//! Vibration that an accelerometer takes for a push: f += k s^2.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};

pub struct VibrationRectification;

const fn push(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "m/s2", low: -1.5, high: 1.5, typical: [0.05, 0.5] }
}

impl Effect for VibrationRectification {
    const CARD: Card = Card {
        id: "vibration_rectification",
        name: "vibration rectification",
        sentence: "the shaking of the motors makes the accelerometer show a push that grows with the throttle",
        kind: EffectKind::Sensor,
        parameters: &[push("x"), push("y"), push("z")],
        writes: &[Quantity::Accelerometer, Quantity::Integrated],
        reads: &[Quantity::ThrustCommand],
        channels: &[ResidualChannel::Force, ResidualChannel::Push],
        signature: "specific force is off by the square of the throttle, and the change of velocity does not know of \
            it",
        rivals: &["throttle_offset", "accel_scale", "accel_bias"],
        manoeuvre: ("throttle ramps and punches", &["ramp-up", "ramp-down", "punch", "chop"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        let load = sensed.throttle * sensed.throttle;
        (0..3).for_each(|i| sensed.force[i] += k[i] * load);
    }
}
