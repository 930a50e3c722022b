//! An IMU away from the centre of mass feels its own turning: f += w' x r + w x (w x r).

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};
use crate::model::attitude::cross;

pub struct ImuLeverArm;

const fn arm(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "m", low: -0.1, high: 0.1, typical: [0.005, 0.03] }
}

impl Effect for ImuLeverArm {
    const CARD: Card = Card {
        id: "imu_lever_arm",
        name: "IMU lever arm",
        sentence: "the flight controller sits away from the centre of mass and feels every turn as acceleration",
        kind: EffectKind::Sensor,
        parameters: &[arm("rx"), arm("ry"), arm("rz")],
        writes: &[Quantity::Accelerometer, Quantity::Integrated],
        reads: &[Quantity::BodyRates, Quantity::AngularAcceleration],
        channels: &[ResidualChannel::Force, ResidualChannel::Push],
        signature: "specific force on all axes follows squares of body rates and angular acceleration, and does not \
            move the vehicle",
        rivals: &["rate_thrust_coupling"],
        manoeuvre: ("flips, spins and sharp rate steps", &["roll-flip", "pitch-flip", "yaw-spin", "rate-steps"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        let r = [k[0], k[1], k[2]];
        let turning = cross(sensed.acceleration, r);
        let centripetal = cross(sensed.rates, cross(sensed.rates, r));
        (0..3).for_each(|i| sensed.force[i] += turning[i] + centripetal[i]);
    }
}
