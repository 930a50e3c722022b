//! Commands that get lost: with some probability the last one is held.

use super::{Card, Channel, Effect, Kind, Parameter};

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "command_dropout",
        name: "lost commands",
        sentence: "now and then the vehicle ignores the sticks for a moment",
        kind: Kind::Random,
        parameters: &[Parameter { name: "probability", unit: "1", low: 0.0, high: 0.5, typical: [0.02, 0.2] }],
        channels: &[Channel::Rate],
        signature: "the gyro scatters more right after the commands change, and hardly else",
        rivals: &["rate_delay"],
        manoeuvre: ("fast stick doublets on every axis, often", &["roll-doublets", "pitch-doublets", "yaw-doublets", "rate-steps"]),
        shown: None,
    };
}
