//! A gyro that is off by a constant: w + b.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Role, Sensed};

pub struct GyroBias;

const fn bias(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "rad/s", low: -0.06, high: 0.06, typical: [0.01, 0.03] }
}

impl Effect for GyroBias {
    const CARD: Card = Card {
        id: "gyro_bias",
        name: "gyro bias",
        sentence: "the gyro shows a slow turn that is not there",
        kind: EffectKind::Sensor,
        parameters: &[bias("x"), bias("y"), bias("z")],
        writes: &[Quantity::Gyro, Quantity::Integrated],
        channels: &[ResidualChannel::Rate, ResidualChannel::Turn],
        role: Role::ConstantError,
        signature: "the integrated gyro drifts away from the attitude at a constant rate",
        rivals: &["weak_motor"],
        manoeuvre: ("calm flight at low and at high throttle", &["ramp-up", "ramp-down", "forward"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        (0..3).for_each(|i| sensed.rates[i] += k[i]);
    }
}
