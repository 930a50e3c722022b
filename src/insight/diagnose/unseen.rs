//! Flight that was not used for fitting: contiguous parts of the time, each predicted by numbers that the others were
//! fitted to.

use super::fit::{FitPoint, costs};
use super::fitted::FittedSelection;
use super::numbers::BEGIN;
use super::problem::Problem;
use super::whiten::Whitener;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use nalgebra::DMatrix;

/// How many parts a single flight is divided into.
const PARTS: usize = 3;

/// Which stretches of time are unseen in each part: a flight at a time where there are several, else a third.
pub fn parts(problem: &Problem) -> Vec<Vec<bool>> {
    let flights = problem.records.len();
    if flights > 1 {
        let of = |record: usize| {
            let mut out = vec![false; problem.blocks];
            problem.records[record].block.iter().for_each(|b| out[*b as usize] = true);
            out
        };
        return (0..flights).map(of).collect();
    }
    let part = |p: usize| (0..problem.blocks).map(|b| b * PARTS / problem.blocks.max(1) == p).collect();
    (0..PARTS).map(part).collect()
}

/// Whether a number is the voltage that a flight begins with.
fn begins(problem: &Problem, k: usize) -> bool {
    (BEGIN..BEGIN + problem.records.len()).contains(&k)
}

/// Inner products of the stretches that are not `out`.
pub fn seen(grams: &Grams, out: &[bool]) -> DMatrix<f64> {
    let n = grams.sum.nrows();
    let kept = grams.blocks.iter().zip(out).filter(|(_, out)| !**out);
    kept.fold(DMatrix::zeros(n, n), |sum, (gram, _)| sum + gram)
}

/// The numbers of `point` as the stretches that are not `out` alone would have them: a step from where all of them lie,
/// which is near. The voltage that an unseen flight begins with is no part of what is judged, and stays.
pub fn without(problem: &Problem, point: &FitPoint, grams: &Grams, out: &[bool]) -> Vec<f64> {
    let mut x = point.x.clone();
    let moving: Vec<usize> = (0..point.free.len()).filter(|&i| !begins(problem, point.free[i])).collect();
    let gram = seen(grams, out);
    let number = |i: usize| &problem.model.numbers[point.free[i]];
    let prior: Vec<f64> = moving.iter().map(|&i| number(i).trust.powi(-2)).collect();
    let Some(inner) = inverse(&Grams::pick(&gram, &moving, &moving), &prior) else { return x };
    let pull = |(row, &i): (usize, &usize)| {
        let k = point.free[i];
        gram[(i, point.free.len())] - prior[row] * (x[k] - problem.model.base[k])
    };
    let downhill = DMatrix::from_iterator(moving.len(), 1, moving.iter().enumerate().map(pull));
    let step = inner * downhill;
    for (row, &i) in moving.iter().enumerate() {
        let n = number(i);
        x[point.free[i]] = (x[point.free[i]] + step[(row, 0)]).clamp(n.low, n.high);
    }
    x
}

/// Whitened squares at `x` by stretch of time.
pub fn squares(problem: &Problem, whitener: &Whitener, x: &[f64]) -> Vec<f64> {
    let residual = problem.residuals(&problem.predict(x));
    costs(problem, &whitener.apply(&residual, &problem.rows))
}

/// By how many standard deviations over the stretches the sum of `differences` is above nothing.
pub fn deviations(differences: &[f64]) -> f64 {
    differences.iter().sum::<f64>() / differences.iter().map(|d| d * d).sum::<f64>().sqrt().max(1e-300)
}

/// How surely each of `effects` (the places of its numbers among the fitted ones) pays on unseen flight, in standard
/// deviations, where each of `parts` in turn is unseen. No stretch tells more than `most` whitened squares, for or
/// against.
pub fn pays(fitted: &FittedSelection, parts: &[Vec<bool>], effects: &[Vec<usize>], most: f64) -> Vec<f64> {
    let (problem, point) = (fitted.problem, fitted.point());
    let whitener = &fitted.selection.whitener;
    let mut gained: Vec<Vec<f64>> = vec![Vec::new(); effects.len()];
    for out in parts {
        let x = without(problem, point, &fitted.grams, out);
        let with = squares(problem, whitener, &x);
        let gram = seen(&fitted.grams, out);
        for (own, gained) in effects.iter().zip(&mut gained) {
            let known = |cost: &[f64]| -> f64 { cost.iter().zip(out).filter(|(_, o)| !**o).map(|(c, _)| c).sum() };
            let tried = removed(fitted, &gram, own, &x).map(|x| squares(problem, whitener, &x));
            // What the others make of its absence is chosen by the flight that is known.
            let [a, b] = tried;
            let missing = if known(&a) <= known(&b) { a } else { b };
            let unseen = (0..problem.blocks).filter(|&b| out[b]);
            gained.extend(unseen.map(|b| (missing[b] - with[b]).clamp(-most, most)));
        }
    }
    gained.iter().map(|differences| deviations(differences)).collect()
}

/// The numbers `x` without those at `own`: the others as they are, and the others with what they can take over.
pub fn removed(fitted: &FittedSelection, gram: &DMatrix<f64>, own: &[usize], x: &[f64]) -> [Vec<f64>; 2] {
    let point = fitted.point();
    let numbers = &fitted.problem.model.numbers;
    let mut plain = x.to_vec();
    own.iter().for_each(|&i| plain[point.free[i]] = 0.0);
    let mut moved = plain.clone();
    let rest: Vec<usize> = fitted.rest(own).into_iter().filter(|&i| !begins(fitted.problem, point.free[i])).collect();
    let prior: Vec<f64> = rest.iter().map(|&i| numbers[point.free[i]].trust.powi(-2)).collect();
    if let Some(inner) = inverse(&Grams::pick(gram, &rest, &rest), &prior) {
        let size = DMatrix::from_iterator(own.len(), 1, own.iter().map(|&i| x[point.free[i]]));
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
    fn four_that_agree_are_two_deviations() {
        assert!((deviations(&[1.0; 4]) - 2.0).abs() < 1e-12);
        assert!(deviations(&[3.0, -1.0, -1.0, -1.0]).abs() < 1e-12);
    }
}
