//! Pure delay of the rate commands: a(t) becomes a(t - d).

use super::{
    Card, CommandDelay, CompactNumber, ControllerPart, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel,
};
use crate::base::lane::Real;

pub struct RateDelay;

impl Effect for RateDelay {
    const CARD: Card = Card {
        id: "rate_delay",
        name: "rate command delay",
        sentence: "the vehicle starts to turn later than its sticks say, on all axes",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter { name: "delay", unit: "s", low: 0.0, high: 0.12, typical: [0.002, 0.05] }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        absorbed_by: &[CompactNumber::RollTime, CompactNumber::PitchTime, CompactNumber::YawTime],
        controller: Some(ControllerPart::Delay),
        signature: "the gyro lags the simulated rate by the same time at every frequency",
        rivals: &["rate_second_order", "stream_offset", "command_dropout", "rate_slew_limit", "yaw_delay"],
        manoeuvre: (
            "sharp steps and fast stick doublets on every axis",
            &["rate-steps", "roll-doublets", "pitch-doublets", "yaw-doublets"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn command_delay<R: Real>(k: &[R], delay: &mut CommandDelay<R>) {
        delay.rates = delay.rates + k[0];
    }
}
