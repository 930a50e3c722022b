//! Gusts: a random force of deviation sigma that is forgotten in tau.

use super::{Card, Channel, Effect, Kind, Parameter};

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "gusts",
        name: "gusts",
        sentence: "the air pushes the vehicle around, for some tenths of a second at a time",
        kind: Kind::Random,
        parameters: &[
            Parameter { name: "sigma", unit: "m/s2", low: 0.0, high: 3.0, typical: [0.2, 1.0] },
            Parameter { name: "tau", unit: "s", low: 0.0, high: 10.0, typical: [0.1, 3.0] },
        ],
        channels: &[Channel::Force],
        signature: "specific force scatters slowly, and nothing that is flown explains it",
        rivals: &[],
        manoeuvre: ("calm hover between all others, on a day with wind and one without", &["circle", "forward", "climb"]),
        shown: None,
    };
}
