//! Whether an effect pays on flight that was not used for fitting.

use crate::insight::criteria::unseen::MOST_EVIDENCE;
use crate::insight::diagnose::fitting::unseen::{begins, deviations, seen, squares, without};
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use nalgebra::DMatrix;

/// How surely an effect pays, in standard deviations.
pub struct Paid {
    /// By all that each stretch gains.
    pub whole: f64,
    /// By no more than [`MOST_EVIDENCE`] of each, for or against: one stretch that gains a thousand times what others
    /// do makes nothing less sure.
    pub limited: f64,
}

impl Paid {
    fn of(gained: &[f64]) -> Self {
        let most = MOST_EVIDENCE.get();
        let limited: Vec<f64> = gained.iter().map(|d| d.clamp(-most, most)).collect();
        Self { whole: deviations(gained), limited: deviations(&limited) }
    }

    /// By the better of both, where it pays at all.
    pub fn surely(&self) -> f64 {
        if self.whole > 0.0 { self.whole.max(self.limited) } else { self.whole }
    }
}

/// How surely each of `effects` (the places of its numbers among the fitted ones) pays on unseen flight, in standard
/// deviations, where each of `parts` in turn is unseen.
pub fn pays(fitted: &FittedSelection, parts: &[Vec<bool>], effects: &[Vec<usize>]) -> Vec<Paid> {
    let (problem, point) = (fitted.problem, fitted.point());
    let whitener = &fitted.selection.whitener;
    let mut gained: Vec<Vec<f64>> = vec![Vec::new(); effects.len()];
    for out in parts {
        let x = without(problem, whitener, point, &fitted.grams, out);
        let with = squares(problem, whitener, &x);
        let gram = seen(&fitted.grams, out);
        for (own, gained) in effects.iter().zip(&mut gained) {
            let known = |cost: &[f64]| -> f64 { cost.iter().zip(out).filter(|(_, o)| !**o).map(|(c, _)| c).sum() };
            let tried = removed(fitted, &gram, own, &x).map(|x| squares(problem, whitener, &x));
            // What the others make of its absence is chosen by the flight that is known.
            let [a, b] = tried;
            let missing = if known(&a) <= known(&b) { a } else { b };
            let unseen = (0..problem.blocks).filter(|&b| out[b]);
            gained.extend(unseen.map(|b| missing[b] - with[b]));
        }
    }
    gained.iter().map(|differences| Paid::of(differences)).collect()
}

/// The numbers `x` with those at `own` as the base vehicle has them, mostly none: the others as they are, and the
/// others with what they can take over.
pub fn removed(fitted: &FittedSelection, gram: &DMatrix<f64>, own: &[usize], x: &[f64]) -> [Vec<f64>; 2] {
    let point = fitted.point();
    let numbers = &fitted.problem.model.numbers;
    let mut plain = x.to_vec();
    own.iter().for_each(|&i| plain[point.free[i]] = fitted.problem.model.base[point.free[i]]);
    let mut moved = plain.clone();
    let rest: Vec<usize> = fitted.rest(own).into_iter().filter(|&i| !begins(fitted.problem, point.free[i])).collect();
    let prior: Vec<f64> = rest.iter().map(|&i| numbers[point.free[i]].trust.powi(-2)).collect();
    if let Some(inner) = inverse(&Grams::pick(gram, &rest, &rest), &prior) {
        let size = DMatrix::from_iterator(own.len(), 1, own.iter().map(|&i| x[point.free[i]] - plain[point.free[i]]));
        let taken = inner * Grams::pick(gram, &rest, own) * size;
        for (row, &i) in rest.iter().enumerate() {
            let (k, n) = (point.free[i], &numbers[point.free[i]]);
            moved[k] = (moved[k] + taken[(row, 0)]).clamp(n.low, n.high);
        }
    }
    [plain, moved]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_stretch_that_gains_much_leaves_the_others_sure() {
        let mut gained = [10.0; 40];
        gained[3] = 30000.0;
        let paid = Paid::of(&gained);
        assert!(paid.whole < 2.0 && paid.surely() > 6.0);
        gained[3] = -30000.0;
        assert!(Paid::of(&gained).surely() < 0.0, "what loses more than it gains pays nothing");
    }
}
