//! Pure delay of the thrust command: u(t) becomes u(t - d).

use super::{Card, CommandDelay, CompactNumber, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct ThrustDelay;

impl Effect for ThrustDelay {
    const CARD: Card = Card {
        id: "thrust_delay",
        name: "thrust command delay",
        sentence: "the motors answer the throttle later than a lag alone explains",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter { name: "delay", unit: "s", low: 0.0, high: 0.12, typical: [0.002, 0.03] }],
        writes: &[Quantity::ThrustCommand],
        channels: &[ResidualChannel::Force],
        absorbed_by: &[CompactNumber::ThrustTime],
        signature: "vertical specific force lags the simulated thrust by the same time at every frequency",
        rivals: &["thrust_asymmetric_lag"],
        manoeuvre: ("throttle steps up and down, and punches", &["throttle-steps", "punch", "chop"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn command_delay<R: Real>(k: &[R], delay: &mut CommandDelay<R>) {
        delay.thrust = delay.thrust + k[0];
    }
}
