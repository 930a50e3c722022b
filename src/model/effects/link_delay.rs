//! Pure delay of every command, as a radio link has it: a(t) becomes a(t - d), thrust included.

use super::{Card, CommandDelay, CompactNumber, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct LinkDelay;

impl Effect for LinkDelay {
    const CARD: Card = Card {
        id: "link_delay",
        name: "delay of all commands",
        sentence: "the vehicle turns and climbs later than its sticks say, by the same time",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter { name: "delay", unit: "s", low: 0.0, high: 0.12, typical: [0.002, 0.03] }],
        parts: &["rate_delay", "thrust_delay"],
        writes: &[Quantity::RateCommand, Quantity::ThrustCommand],
        channels: &[ResidualChannel::Rate, ResidualChannel::Force],
        absorbed_by: &[
            CompactNumber::RollTime,
            CompactNumber::PitchTime,
            CompactNumber::YawTime,
            CompactNumber::ThrustTime,
        ],
        signature: "rates and vertical specific force lag the simulated ones by the same time",
        rivals: &["rate_delay", "thrust_delay", "command_dropout"],
        manoeuvre: (
            "sharp steps and fast doublets of every stick",
            &["rate-steps", "roll-doublets", "pitch-doublets", "throttle-steps"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn command_delay<R: Real>(k: &[R], delay: &mut CommandDelay<R>) {
        (delay.rates, delay.thrust) = (delay.rates + k[0], delay.thrust + k[0]);
    }
}
