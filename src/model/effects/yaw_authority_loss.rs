//! Yaw that fades where the motors saturate: the yaw command is scaled by 1 - k sat(s), sat rising from 0 at s = 0.8
//! to 1 at 1.

use super::{Card, CommandSetpoint, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct YawAuthorityLoss;

impl Effect for YawAuthorityLoss {
    const CARD: Card = Card {
        id: "yaw_authority_loss",
        name: "loss of yaw authority",
        sentence: "near full throttle the vehicle yaws less than asked",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter { name: "k", unit: "1", low: 0.0, high: 1.0, typical: [0.1, 0.6] }],
        writes: &[Quantity::RateCommand],
        reads: &[Quantity::ThrustCommand],
        channels: &[ResidualChannel::Rate],
        signature: "the yaw rate falls short only where throttle and yaw command are both large",
        manoeuvre: ("yaw steps at full throttle", &["punch-turns"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn setpoint<R: Real>(k: &[R], setpoint: &mut CommandSetpoint<R>) {
        let saturated = ((setpoint.throttle - R::of(0.8)) * R::of(5.0)).clamp(R::zero(), R::one());
        setpoint.command[2] = setpoint.command[2] * (R::one() - k[0] * saturated);
    }
}
