//! Commands that get lost: with some probability the last one is held.

use super::{Card, Effect, EffectKind, EffectParameter, Evidence, Quantity, ResidualChannel, Role, Twin};

pub struct CommandDropout;

impl Effect for CommandDropout {
    const CARD: Card = Card {
        id: "command_dropout",
        name: "lost commands",
        sentence: "now and then the vehicle ignores the sticks for a moment",
        kind: EffectKind::Random,
        parameters: &[EffectParameter { name: "probability", unit: "1", low: 0.0, high: 0.5, typical: [0.02, 0.2] }],
        writes: &[Quantity::RateCommand, Quantity::ThrustCommand],
        channels: &[ResidualChannel::Rate],
        role: Role::CommandsLost,
        twin: Some(Twin { effect: "rate_delay", told_by: Evidence::SingleMovements }),
        signature: "the gyro scatters more right after the commands change, and hardly else",
        rivals: &["rate_delay"],
        manoeuvre: (
            "fast stick doublets on every axis, often",
            &["roll-doublets", "pitch-doublets", "yaw-doublets", "rate-steps"],
        ),
        ..Card::BLANK
    };
}
