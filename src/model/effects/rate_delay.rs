//! Pure delay of the rate commands: a(t) becomes a(t - d).

use super::{Card, Channel, Effect, Kind, Late, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "rate_delay",
        name: "rate command delay",
        sentence: "the vehicle starts to turn later than its sticks say, on all axes",
        kind: Kind::Timing,
        parameters: &[Parameter { name: "delay", unit: "s", low: 0.0, high: 0.12, typical: [0.002, 0.05] }],
        channels: &[Channel::Rate],
        signature: "the gyro lags the simulated rate by the same time at every frequency",
        rivals: &["rate_second_order", "stream_offset", "command_dropout", "rate_slew_limit", "yaw_delay"],
        manoeuvre: ("sharp steps and fast stick doublets on every axis", &["rate-steps", "roll-doublets", "pitch-doublets", "yaw-doublets"]),
        shown: None,
    };

    #[inline(always)]
    fn late<R: Real>(k: &[R], late: &mut Late<R>) {
        late.rates = late.rates + k[0];
    }
}
