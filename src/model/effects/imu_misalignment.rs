//! An IMU that is mounted askew: rates and force x become x + r x x, r the small rotation from the body to the sensor.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};
use crate::model::attitude::cross;

pub struct ImuMisalignment;

const fn angle(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "rad", low: -0.2, high: 0.2, typical: [0.005, 0.07] }
}

impl Effect for ImuMisalignment {
    const CARD: Card = Card {
        id: "imu_misalignment",
        name: "IMU mounted askew",
        sentence: "the flight controller is not mounted level or straight, so that thrust seems to push sideways",
        kind: EffectKind::Sensor,
        parameters: &[angle("rx"), angle("ry"), angle("rz")],
        writes: &[Quantity::Gyro, Quantity::Accelerometer, Quantity::Integrated],
        channels: &[ResidualChannel::Rate, ResidualChannel::Force, ResidualChannel::Turn, ResidualChannel::Push],
        signature: "horizontal specific force follows the thrust and off-axis gyro the rates, and neither moves the \
            vehicle",
        rivals: &["rate_cross_coupling", "accel_bias", "velocity_lag"],
        manoeuvre: (
            "throttle ramps and flips on one axis at a time",
            &["ramp-up", "punch", "roll-flip", "pitch-flip", "yaw-spin"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        let r = [k[0], k[1], k[2]];
        for read in [&mut sensed.rates, &mut sensed.force] {
            let turned = cross(r, *read);
            (0..3).for_each(|i| read[i] += turned[i]);
        }
    }
}
