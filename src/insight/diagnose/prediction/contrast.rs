//! Two sets of flights of one vehicle in one problem: more numbers, by which the later flights differ from the others.

use super::model::Model;
use super::numbers::{DRAG, FORMS, MAX_RATE, ModelNumber, TAU, THRUST, span};
use crate::model::effects;
use std::borrow::Cow;
use std::ops::Range;

/// What a difference moves.
#[derive(Clone, Debug)]
enum Moves {
    /// A number, by so much.
    By(usize),
    /// Numbers, each by the same share of itself.
    Share(Range<usize>),
    /// The size of what turns the voltage about the middle of the battery, as if about a full one: the thrust moves
    /// too. Below 0 it is of the earlier flights, since only the ratio of what both leave of the voltage is known.
    AboutFull(usize),
}

impl Moves {
    fn has(&self, k: usize) -> bool {
        match self {
            Moves::By(own) | Moves::AboutFull(own) => *own == k,
            Moves::Share(range) => range.contains(&k),
        }
    }
}

/// See the module. A difference of 0 is none.
#[derive(Debug)]
pub struct Contrast {
    /// Whether each flight is a later one.
    pub later: Vec<bool>,
    /// By how much each flight's odometry was moved to its gyro before, s.
    pub moved_s: Vec<f64>,
    /// Where the differences begin among the numbers.
    first: usize,
    moves: Vec<Moves>,
}

impl Contrast {
    /// Adds to the numbers of `model` the differences of everything that is no single flight's.
    pub fn new(model: &mut Model, later: Vec<bool>, moved_s: Vec<f64>) -> Self {
        // Roll and pitch by one share: a flight turns hard about each only a few times, and what changes the response
        // of one, gains or motors, changes that of the other.
        let axes = |first: usize| [first..first + 2, first + 2..first + 3];
        let single = (TAU.start + 3..TAU.end).chain(DRAG).map(|k| k..k + 1);
        let shares = axes(TAU.start).into_iter().chain(axes(MAX_RATE.start)).chain(single).chain([THRUST]);
        let shares = shares.map(Moves::Share);
        let about_full = effects::cards().filter(|card| card.about_full).map(|card| span(card).start);
        let about_full: Vec<usize> = about_full.collect();
        let by = |k: usize| if about_full.contains(&k) { Moves::AboutFull(k) } else { Moves::By(k) };
        let moves: Vec<Moves> = shares.chain((DRAG.end..FORMS).map(by)).collect();
        let first = model.numbers.len();
        for moved in &moves {
            let number = match moved {
                Moves::By(k) | Moves::AboutFull(k) => {
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
        Self { later, moved_s, first, moves }
    }

    /// Where the difference of number `k` is.
    pub fn of(&self, k: usize) -> Option<usize> {
        self.moves.iter().position(|moves| moves.has(k)).map(|i| self.first + i)
    }

    /// Whether number `k` has a part in `flight`.
    pub fn reaches(&self, flight: usize, k: usize) -> bool {
        k < self.first || self.later[flight] || matches!(self.moves[k - self.first], Moves::AboutFull(..))
    }

    /// The numbers of `flight` at `x`.
    pub fn numbers<'a>(&self, model: &Model, flight: usize, x: &'a [f64]) -> Cow<'a, [f64]> {
        let mut own: Cow<[f64]> = x.into();
        let later = self.later[flight];
        for (moves, by) in self.moves.iter().zip(&x[self.first..]).filter(|(_, by)| **by != 0.0) {
            match moves {
                Moves::By(k) if later => own.to_mut()[*k] = within(x[*k] + by, &model.numbers[*k]),
                Moves::Share(range) if later => range.clone().for_each(|k| own.to_mut()[k] = x[k] * (1.0 + by)),
                Moves::AboutFull(k) if later == (*by > 0.0) => {
                    let own = own.to_mut();
                    own[*k] = (x[*k] + by.abs()).min(model.numbers[*k].high);
                    model.about_full(own, by.abs());
                }
                _ => {}
            }
        }
        own
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::vehicle::Vehicle;

    #[test]
    fn what_turns_about_a_full_battery_leaves_the_thrust_there_as_it_was() {
        let vehicle = Vehicle::load("seed_class").expect("a vehicle");
        let mut model = Model::new(&vehicle, &[24.0, 24.0]);
        let contrast = Contrast::new(&mut model, vec![false, true], vec![0.0; 2]);
        let card = effects::cards().find(|card| card.about_full).expect("one");
        let d = contrast.of(span(card).start).expect("a difference");
        // At half throttle and these volts, with the effect's own equation.
        let thrust = |x: &[f64], volts: f64| {
            let (share, c) = (x[span(card).start], &x[THRUST]);
            let seen = volts + share * (model.middle_v() - volts);
            c[0] + c[4] * seen + 0.5 * (c[1] + c[5] * seen)
        };
        for (by, without) in [(0.4, 0), (-0.4, 1)] {
            let mut x = model.base.clone();
            x[d] = by;
            let flights = [0, 1].map(|flight| contrast.numbers(&model, flight, &x).into_owned());
            assert_eq!(flights[without], x);
            assert!((flights[1 - without][span(card).start] - 0.4).abs() < 1e-12);
            let full = vehicle.battery.full_v;
            let at = |volts: f64| [without, 1 - without].map(|f| thrust(&flights[f], volts));
            let [[a, b], [c, d]] = [at(full), at(full - 2.0)];
            assert!((a - b).abs() < 1e-9, "the same with a full battery: {a} {b}");
            assert!(((b - d) / (a - c) - 0.6).abs() < 1e-9, "0.6 of the fall is left");
        }
    }
}
