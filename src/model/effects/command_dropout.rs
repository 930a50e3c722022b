//! Commands that get lost: with some probability the last one is held.

use super::{Card, ResidualChannel, Effect, EffectKind, EffectParameter};

pub struct CommandDropout;

impl Effect for CommandDropout {
    const CARD: Card = Card {
        id: "command_dropout",
        name: "lost commands",
        sentence: "now and then the vehicle ignores the sticks for a moment",
        kind: EffectKind::Random,
        parameters: &[EffectParameter { name: "probability", unit: "1", low: 0.0, high: 0.5, typical: [0.02, 0.2] }],
        channels: &[ResidualChannel::Rate],
        signature: "the gyro scatters more right after the commands change, and hardly else",
        rivals: &["rate_delay"],
        manoeuvre: ("fast stick doublets on every axis, often", &["roll-doublets", "pitch-doublets", "yaw-doublets", "rate-steps"]),
        shown: None,
    };
}
