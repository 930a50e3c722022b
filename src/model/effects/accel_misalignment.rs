//! An accelerometer that is turned against the gyro: force f becomes f + r x f, r the small rotation from the one to
//! the other. Parts of one chip differ by up to some 0.02 rad (cross-axis sensitivity in data sheets).

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};
use crate::model::attitude::cross;

pub struct AccelMisalignment;

const fn angle(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "rad", low: -0.2, high: 0.2, typical: [0.01, 0.05] }
}

impl Effect for AccelMisalignment {
    const CARD: Card = Card {
        id: "accel_misalignment",
        name: "accelerometer turned against the gyro",
        sentence: "thrust seems to push sideways, though the gyro is mounted straight",
        kind: EffectKind::Sensor,
        parameters: &[angle("rx"), angle("ry"), angle("rz")],
        writes: &[Quantity::Accelerometer, Quantity::Integrated],
        channels: &[ResidualChannel::Force, ResidualChannel::Push],
        signature: "horizontal specific force follows the thrust, and neither the change of velocity nor the gyro \
            knows of it",
        rivals: &["imu_misalignment", "accel_bias", "vibration_rectification"],
        manoeuvre: ("throttle ramps and punches", &["ramp-up", "ramp-down", "punch", "chop"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        let turned = cross([k[0], k[1], k[2]], sensed.force);
        (0..3).for_each(|i| sensed.force[i] += turned[i]);
    }
}
