//! Largest angular acceleration of yaw alone. Yaw is turned by the rotors' reaction torque, a tenth of what turns roll
//! and pitch on most quadrotors.

use super::{Actuator, Card, Effect, EffectKind, EffectParameter, Quantity, RateResponse, ResidualChannel};
use crate::base::lane::Real;

pub struct YawSlewLimit;

impl Effect for YawSlewLimit {
    const CARD: Card = Card {
        id: "yaw_slew_limit",
        name: "yaw acceleration limit",
        sentence: "large yaw steps take longer than small ones, those of roll and pitch do not",
        kind: EffectKind::Timing,
        // One over the limit, so that none is 0.
        parameters: &[EffectParameter {
            name: "slew",
            unit: "s2/rad",
            low: 0.0,
            high: 0.5,
            typical: [1.0 / 60.0, 1.0 / 10.0],
        }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        response: RateResponse::Limited,
        apart_from: &["rate_delay", "rate_second_order", "rate_slew_limit"],
        signature: "the gyro's yaw falls behind after large steps only, along a straight line",
        rivals: &["yaw_delay", "yaw_second_order", "rate_slew_limit"],
        manoeuvre: ("yaw steps of several sizes", &["yaw-steps", "yaw-doublets"]),
        shown: Some(|k, _| vec![("limit", 1.0 / k[0].max(1e-9), "rad/s2")]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn actuator<R: Real>(k: &[R], actuator: &mut Actuator<R>) {
        actuator.slew[2] = actuator.slew[2] + k[0];
    }
}
