//! Two sets of flights of one vehicle in one problem: more numbers, by which the later flights differ from the others.

use super::model::Model;
use super::numbers::{DRAG, FORMS, MAX_RATE, ModelNumber, TAU, THRUST};
use std::borrow::Cow;
use std::ops::Range;

/// What a difference moves.
#[derive(Clone, Debug)]
enum Moves {
    /// A number, by so much.
    By(usize),
    /// Numbers, each by the same share of itself.
    Share(Range<usize>),
}

impl Moves {
    fn has(&self, k: usize) -> bool {
        match self {
            Moves::By(own) => *own == k,
            Moves::Share(range) => range.contains(&k),
        }
    }
}

/// See the module. A difference of 0 is none.
#[derive(Debug)]
pub struct Contrast {
    /// Whether each flight is a later one.
    pub later: Vec<bool>,
    /// Where the differences begin among the numbers.
    first: usize,
    moves: Vec<Moves>,
}

impl Contrast {
    /// Adds to the numbers of `model` the differences of everything that is no single flight's.
    pub fn new(model: &mut Model, later: Vec<bool>) -> Self {
        // Roll and pitch by one share: a flight turns hard about each only a few times, and what changes the response
        // of one, gains or motors, changes that of the other.
        let axes = |first: usize| [first..first + 2, first + 2..first + 3];
        let single = (TAU.start + 3..TAU.end).chain(DRAG).map(|k| k..k + 1);
        let shares = axes(TAU.start).into_iter().chain(axes(MAX_RATE.start)).chain(single).chain([THRUST]);
        let shares = shares.map(Moves::Share);
        let moves: Vec<Moves> = shares.chain((DRAG.end..FORMS).map(Moves::By)).collect();
        let first = model.numbers.len();
        for moved in &moves {
            let number = match moved {
                Moves::By(k) => {
                    let n = model.numbers[*k].clone();
                    let width = n.high - n.low;
                    ModelNumber { low: -width, high: width, ..n }
                }
                Moves::Share(range) => {
                    let n = model.numbers[range.start].clone();
                    ModelNumber { unit: "1", low: -0.8, high: 4.0, step: 1e-3, trust: 1.0, ..n }
                }
            };
            model.numbers.push(number);
            model.base.push(0.0);
        }
        Self { later, first, moves }
    }

    /// Where the difference of number `k` is.
    pub fn of(&self, k: usize) -> Option<usize> {
        self.moves.iter().position(|moves| moves.has(k)).map(|i| self.first + i)
    }

    /// Whether number `k` has a part in `flight`.
    pub fn reaches(&self, flight: usize, k: usize) -> bool {
        k < self.first || self.later[flight]
    }

    /// The numbers of `flight` at `x`.
    pub fn numbers<'a>(&self, model: &Model, flight: usize, x: &'a [f64]) -> Cow<'a, [f64]> {
        if !self.later[flight] {
            return x.into();
        }
        let mut own = x.to_vec();
        for (moves, by) in self.moves.iter().zip(&x[self.first..]).filter(|(_, by)| **by != 0.0) {
            match moves {
                Moves::By(k) => own[*k] = within(x[*k] + by, &model.numbers[*k]),
                Moves::Share(range) => range.clone().for_each(|k| own[k] = x[k] * (1.0 + by)),
            }
        }
        own.into()
    }
}

/// A value within the bounds of its number. One beyond is reflected: there too a difference has to have a slope, or
/// nothing would be known of an effect that went.
fn within(value: f64, number: &ModelNumber) -> f64 {
    let ModelNumber { low, high, .. } = *number;
    let reflected = if value < low {
        2.0 * low - value
    } else if value > high {
        2.0 * high - value
    } else {
        value
    };
    reflected.clamp(low, high)
}
