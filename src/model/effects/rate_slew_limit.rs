//! Largest angular acceleration: |dw/dt| <= alpha_max, in yaw 30 % of that of roll and pitch.

use super::{
    Actuator, Card, ControllerPart, Effect, EffectKind, EffectParameter, Quantity, RateResponse, ResidualChannel,
};
use crate::base::lane::Real;

pub struct RateSlewLimit;

/// Yaw comes from reaction torque, which is weaker.
pub const YAW_SLEW_SHARE: f64 = 0.3;

impl Effect for RateSlewLimit {
    const CARD: Card = Card {
        id: "rate_slew_limit",
        name: "angular acceleration limit",
        sentence: "large stick steps take longer than small ones, because the motors cannot turn the vehicle faster up",
        kind: EffectKind::Timing,
        // One over the limit, so that none is 0.
        parameters: &[EffectParameter {
            name: "slew",
            unit: "s2/rad",
            low: 0.0,
            high: 0.05,
            typical: [1.0 / 600.0, 1.0 / 100.0],
        }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        response: RateResponse::Limited,
        controller: Some(ControllerPart::Slew),
        signature: "the gyro falls behind after large steps only, along a straight line",
        rivals: &["rate_delay", "rate_second_order", "rate_expo"],
        manoeuvre: ("steps of several sizes on every axis", &["rate-steps", "roll-steps", "pitch-steps", "yaw-steps"]),
        shown: Some(|k, _| vec![("limit", 1.0 / k[0].max(1e-9), "rad/s2")]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn actuator<R: Real>(k: &[R], actuator: &mut Actuator<R>) {
        let yaw = k[0] * R::of(1.0 / YAW_SLEW_SHARE);
        actuator.slew = [actuator.slew[0] + k[0], actuator.slew[1] + k[0], actuator.slew[2] + yaw];
    }
}
