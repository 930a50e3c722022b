//! A throttle that is off by a constant: s becomes s + u0.

use super::{Card, CompactNumber, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, ThrustInput};
use crate::base::lane::Real;

pub struct ThrottleOffset;

impl Effect for ThrottleOffset {
    const CARD: Card = Card {
        id: "throttle_offset",
        name: "throttle offset",
        sentence: "the vehicle lifts off at a lower or higher stick than it should, and the stick is off by the same \
            everywhere",
        kind: EffectKind::Thrust,
        parameters: &[EffectParameter { name: "u0", unit: "1", low: -0.15, high: 0.15, typical: [0.01, 0.05] }],
        writes: &[Quantity::SpecificForce],
        channels: &[ResidualChannel::Force],
        absorbed_by: &[CompactNumber::Thrust],
        signature: "vertical specific force is off by the slope of the thrust curve",
        rivals: &["thrust_asymmetric_lag", "vibration_rectification"],
        manoeuvre: ("slow throttle ramps from none to full", &["ramp-up", "ramp-down"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn thrust_input<R: Real>(k: &[R], input: &mut ThrustInput<R>) {
        input.command = input.command + k[0] + k[0];
    }
}
