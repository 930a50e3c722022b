//! Gusts: a random force of deviation sigma that is forgotten in tau.

use super::{Card, Effect, EffectKind, EffectParameter, ResidualChannel, Role};

pub struct Gusts;

impl Effect for Gusts {
    const CARD: Card = Card {
        id: "gusts",
        name: "gusts",
        sentence: "the air pushes the vehicle around, for some tenths of a second at a time",
        kind: EffectKind::Random,
        parameters: &[
            EffectParameter { name: "sigma", unit: "m/s2", low: 0.0, high: 3.0, typical: [0.2, 1.0] },
            EffectParameter { name: "tau", unit: "s", low: 0.0, high: 10.0, typical: [0.1, 3.0] },
        ],
        shape: Some(1),
        channels: &[ResidualChannel::Force],
        role: Role::RandomForce,
        signature: "specific force scatters slowly, and nothing that is flown explains it",
        manoeuvre: (
            "calm hover between all others, on a day with wind and one without",
            &["circle", "forward", "climb"],
        ),
        ..Card::BLANK
    };
}
