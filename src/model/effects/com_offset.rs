//! A centre of mass away from the point r whose velocity and acceleration the log has, such as the middle of a motion
//! capture's markers: that point is accelerated by w' x r + w x (w x r) more. Velocity and accelerometer agree on it,
//! as they do not on an IMU's lever arm. The airspeed of the centre, less by w x r, is taken as the point's.

use super::imu_lever_arm::ImuLeverArm;
use super::{Card, Effect, EffectKind, Quantity, ResidualChannel, Sensed};

pub struct ComOffset;

impl Effect for ComOffset {
    const CARD: Card = Card {
        id: "com_offset",
        name: "centre of mass offset",
        sentence: "the vehicle turns about another point than the one whose velocity and acceleration are logged",
        kind: EffectKind::Sensor,
        parameters: ImuLeverArm::CARD.parameters,
        writes: &[Quantity::Accelerometer],
        reads: ImuLeverArm::CARD.reads,
        channels: &[ResidualChannel::Force],
        signature: "specific force on all axes follows squares of body rates and angular acceleration, and the \
            velocity does as well",
        rivals: &["imu_lever_arm", "rate_thrust_coupling"],
        manoeuvre: ImuLeverArm::CARD.manoeuvre,
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        ImuLeverArm::sense(k, sensed);
    }
}
