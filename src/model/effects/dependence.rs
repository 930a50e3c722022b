//! What depends on what: the compact model's own ways, and those that the cards of present effects add.

use super::card::Card;
use super::quantity::Quantity;

/// Of the compact model: what the second needs the first for.
const COMPACT: [(Quantity, Quantity); 12] = {
    use Quantity::*;
    [
        (RateCommand, BodyRates),
        (RateCommand, AngularAcceleration),
        (RateCommand, RateError),
        (ThrustCommand, SpecificForce),
        (BodyRates, AngularAcceleration),
        (BodyRates, Gyro),
        (Voltage, SpecificForce),
        (GyroTime, Gyro),
        (GyroTime, Integrated),
        (Velocity, SpecificForce),
        (Velocity, Integrated),
        (SpecificForce, Accelerometer),
    ]
};

/// A set of quantities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quantities(u16);

impl Quantities {
    pub const NONE: Quantities = Quantities(0);
    pub const ALL: Quantities = Quantities((1 << (Quantity::Integrated as u16 + 1)) - 1);

    pub fn of(all: &[Quantity]) -> Self {
        all.iter().fold(Self::NONE, |set, q| set.with(*q))
    }

    pub fn with(self, q: Quantity) -> Self {
        Quantities(self.0 | 1 << q as u16)
    }

    pub fn and(self, others: Self) -> Self {
        Quantities(self.0 | others.0)
    }

    pub fn has(self, q: Quantity) -> bool {
        self.0 & 1 << q as u16 != 0
    }

    /// Whether it has one of these.
    pub fn any(self, of: &[Quantity]) -> bool {
        of.iter().any(|q| self.has(*q))
    }

    /// These and all that depends on them where the effects `present` are.
    pub fn reached(mut self, present: &[&Card]) -> Self {
        loop {
            let compact = COMPACT.iter().filter(|(from, _)| self.has(*from));
            let mut next = compact.fold(self, |set, (_, to)| set.with(*to));
            for card in present {
                let read = card.reads.iter().filter(|from| self.has(**from));
                let ways = read.flat_map(|from| card.writes.iter().map(move |to| (*from, *to)));
                next = ways.filter(|way| carries(*way)).fold(next, |set, (_, to)| set.with(to));
            }
            if next == self {
                return self;
            }
            self = next;
        }
    }
}

/// What is integrated are measured rates and forces: of the model, a correction of theirs sees the throttle alone.
fn carries((from, to): (Quantity, Quantity)) -> bool {
    to != Quantity::Integrated || from == Quantity::ThrustCommand
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_reaches_what_is_computed_from_it_and_no_more() {
        use Quantity::*;
        let delay = Quantities::of(&[RateCommand]).reached(&[]);
        assert_eq!(delay, Quantities::of(&[RateCommand, BodyRates, AngularAcceleration, RateError, Gyro]));
        let mixer = Card { reads: &[RateError], writes: &[SpecificForce], ..Card::BLANK };
        let mixed = Quantities::of(&[RateCommand]).reached(&[&mixer]);
        assert_eq!(mixed, delay.with(SpecificForce).with(Accelerometer));
        let shaken = Card { reads: &[ThrustCommand], writes: &[Accelerometer, Integrated], ..Card::BLANK };
        assert!(Quantities::of(&[ThrustCommand]).reached(&[&shaken]).has(Integrated));
        let arm = Card { reads: &[BodyRates], writes: &[Accelerometer, Integrated], ..Card::BLANK };
        assert!(!delay.reached(&[&arm]).has(Integrated));
    }
}
