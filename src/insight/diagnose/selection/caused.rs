//! One effect in the place of all moves of thrust and drag against the base vehicle.

use crate::insight::diagnose::fitting::fit;
use crate::insight::diagnose::prediction::model::Model;
use crate::insight::diagnose::prediction::numbers::{is_force, span};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::{Added, Selection};
use crate::model::effects::Card;

/// How an effect may act on the base vehicle.
#[derive(Clone, Copy, Debug)]
pub struct ForceCause {
    pub card: &'static Card,
    /// Whether it turns the voltage about a full battery, and not about its middle: the thrust moves too.
    pub about_full: bool,
    /// What the base vehicle is off by beside it, see [`Model::off`].
    pub off: [f64; 2],
}

impl ForceCause {
    /// All ways of an effect.
    pub fn of(card: &'static Card) -> impl Iterator<Item = Self> {
        let about_full: &[bool] = if card.about_full { &[false, true] } else { &[false] };
        about_full.iter().map(move |&about_full| Self { card, about_full, off: [0.0; 2] })
    }

    /// The numbers of `x`, with thrust and drag as the base vehicle has them under the effect of this size.
    pub fn numbers(self, model: &Model, x: &[f64], size: f64) -> Vec<f64> {
        let given = |(k, x): (usize, &f64)| if is_force(k) { model.base[k] } else { *x };
        let mut x: Vec<f64> = x.iter().enumerate().map(given).collect();
        model.off(&mut x, self.off);
        x[span(self.card).start] = size;
        if self.about_full {
            model.about_full(&mut x, size);
        }
        x
    }
}

impl Selection {
    /// The same with an effect in the place of all moves of thrust and drag against the base vehicle, fitted from
    /// `size`.
    pub fn with_cause(&self, problem: &Problem, way: ForceCause, size: f64) -> Self {
        let own = span(way.card).start;
        let free: Vec<usize> = self.point.free.iter().copied().filter(|k| !is_force(*k)).chain([own]).collect();
        let fitted = |x: &[f64]| fit::fit(problem, &self.whitener, x, &free);
        let mut point = fitted(&way.numbers(&problem.model, &self.point.x, size));
        // The thrust was moved for the size that it began with.
        if way.about_full {
            point = fitted(&way.numbers(&problem.model, &point.x, point.x[own]));
        }
        let mut caused = Self { point, ..self.but(problem, &[]) };
        caused.added.push(Added { card: way.card, ties: Vec::new() });
        caused
    }
}
