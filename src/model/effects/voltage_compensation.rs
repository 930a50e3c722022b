//! Firmware that scales the motors with the voltage: a share of its change never reaches the thrust.

use super::{Card, CompactNumber, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, ThrustInput};
use crate::base::lane::Real;

pub struct VoltageCompensation;

impl Effect for VoltageCompensation {
    const CARD: Card = Card {
        id: "voltage_compensation",
        name: "voltage compensation",
        sentence: "the same stick gives the same thrust late in the pack, because the flight controller makes up for \
            the voltage",
        kind: EffectKind::Thrust,
        // All of it, 1, is what controllers aim at: no end of the range.
        parameters: &[EffectParameter { name: "share", unit: "1", low: 0.0, high: 1.2, typical: [0.2, 1.0] }],
        writes: &[Quantity::SpecificForce],
        channels: &[ResidualChannel::Force],
        absorbed_by: &[CompactNumber::Thrust],
        about_full: true,
        signature: "the thrust does not fall with the voltage as the thrust curve says",
        rivals: &["thrust_fade"],
        manoeuvre: (
            "the same throttle with a full and with an empty battery, in punches and at rest",
            &["throttle-steps", "punch", "climb"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn thrust_input<R: Real>(k: &[R], input: &mut ThrustInput<R>) {
        let rest = R::one() - k[0];
        input.voltage = rest.mul_add(input.voltage - input.middle_v, input.middle_v);
    }
}
