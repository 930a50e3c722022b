//! Pure delay of the yaw command beyond that of roll and pitch, of either sign: yaw goes through other filters and is
//! made by torque, not by thrust.
//! The catalogue had one delay for all axes; IndiFlight's flights ask for two.

use super::{
    Card, CommandDelay, CompactNumber, ControllerPart, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel,
};
use crate::base::lane::Real;

pub struct YawDelay;

impl Effect for YawDelay {
    const CARD: Card = Card {
        id: "yaw_delay",
        name: "yaw command delay",
        sentence: "yaw starts to turn later, or earlier, than roll and pitch do",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter { name: "extra", unit: "s", low: -0.06, high: 0.06, typical: [0.004, 0.03] }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        absorbed_by: &[CompactNumber::YawTime],
        apart_from: &["rate_delay", "link_delay"],
        controller: Some(ControllerPart::YawDelay),
        signature: "the gyro's yaw lags the simulated rate by another time than its roll and pitch",
        rivals: &["rate_delay"],
        manoeuvre: ("sharp yaw steps and doublets", &["yaw-steps", "yaw-doublets", "yaw-spin"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn command_delay<R: Real>(k: &[R], delay: &mut CommandDelay<R>) {
        delay.yaw = delay.yaw + k[0];
    }
}
