//! A centre of mass away from the point r whose velocity and acceleration the log has, such as the middle of a motion
//! capture's markers: that point is accelerated by w' x r + w x (w x r) more. Velocity and accelerometer agree on it,
//! as they do not on an IMU's lever arm. The airspeed of the centre, less by w x r, is taken as the point's.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Sensed};
use crate::model::attitude::carried;

pub struct ComOffset;

const fn arm(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "m", low: -0.1, high: 0.1, typical: [0.005, 0.03] }
}

impl Effect for ComOffset {
    const CARD: Card = Card {
        id: "com_offset",
        name: "centre of mass offset",
        sentence: "the vehicle turns about another point than the one whose velocity and acceleration are logged",
        kind: EffectKind::Sensor,
        parameters: &[arm("rx"), arm("ry"), arm("rz")],
        writes: &[Quantity::Accelerometer],
        reads: &[Quantity::BodyRates, Quantity::AngularAcceleration],
        channels: &[ResidualChannel::Force],
        signature: "specific force on all axes follows squares of body rates and angular acceleration, and the \
            velocity does as well",
        rivals: &["imu_lever_arm", "rate_thrust_coupling"],
        manoeuvre: ("flips, spins and sharp rate steps", &["roll-flip", "pitch-flip", "yaw-spin", "rate-steps"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn sense(k: &[f64], sensed: &mut Sensed) {
        let felt = carried(sensed.rates, sensed.acceleration, [k[0], k[1], k[2]]);
        (0..3).for_each(|i| sensed.force[i] += felt[i]);
    }
}
