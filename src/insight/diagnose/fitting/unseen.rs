//! Flight that was not used for fitting: contiguous parts of the time, each predicted by numbers that the others were
//! fitted to.

use super::fit::{FitPoint, costs, fit};
use super::whiten::Whitener;
use crate::insight::criteria::unseen::{MOST_UNSEEN, MUCH_WORSE_SHARE, WORSE_DEVIATIONS, WORSE_SHARE};
use crate::insight::diagnose::prediction::numbers::BEGIN;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::prediction::record::FlightRecord;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use nalgebra::DMatrix;

/// How many parts a flight is divided into that holds most of all.
const PARTS: usize = 3;
/// A step leads to what is near where it gains this share of what it should.
const NEAR: f64 = 0.5;

/// Which stretches of time are unseen in each part: a flight at a time where there are several, else a third.
pub fn parts(problem: &Problem) -> Vec<Vec<bool>> {
    let several = problem.records.len() > 1;
    divided(problem, |_| if several { 1 } else { PARTS })
}

/// The same with a flight that holds most of all in thirds: what the others know is no measure of what it shows. For
/// names; a vehicle has to predict whole flights.
pub fn even_parts(problem: &Problem) -> Vec<Vec<bool>> {
    let most = |[first, beyond]: [usize; 2]| (beyond - first) as f64 > MOST_UNSEEN.get() * problem.blocks as f64;
    divided(problem, |record| if ends(record).is_some_and(most) { PARTS } else { 1 })
}

/// Every flight in so many parts.
fn divided(problem: &Problem, count: impl Fn(&FlightRecord) -> usize) -> Vec<Vec<bool>> {
    let mut out = Vec::new();
    for record in &problem.records {
        let count = count(record);
        out.extend((0..count).map(|part| of_parts(problem, record, part, count)));
    }
    out
}

/// Stretches of each third of every flight.
pub fn thirds(problem: &Problem) -> Vec<Vec<bool>> {
    let third = |part: usize| {
        let each = problem.records.iter().map(|record| of_parts(problem, record, part, PARTS));
        each.fold(vec![false; problem.blocks], |all, one| all.iter().zip(one).map(|(a, b)| *a || b).collect())
    };
    (0..PARTS).map(third).collect()
}

/// The stretches of one of so many parts of a flight.
fn of_parts(problem: &Problem, record: &FlightRecord, part: usize, count: usize) -> Vec<bool> {
    let mut out = vec![false; problem.blocks];
    if let Some([first, beyond]) = ends(record) {
        let at = |part: usize| first + ((beyond - first) * part).div_ceil(count);
        out[at(part)..at(part + 1)].fill(true);
    }
    out
}

/// The first stretch of a flight, and one beyond its last.
fn ends(record: &FlightRecord) -> Option<[usize; 2]> {
    record.block.first().zip(record.block.last()).map(|(first, last)| [*first as usize, *last as usize + 1])
}

/// Whether a number is the voltage that a flight begins with.
pub fn begins(problem: &Problem, k: usize) -> bool {
    (BEGIN..BEGIN + problem.records.len()).contains(&k)
}

/// Inner products of the stretches that are not `out`.
pub fn seen(grams: &Grams, out: &[bool]) -> DMatrix<f64> {
    let n = grams.sum.nrows();
    let kept = grams.blocks.iter().zip(out).filter(|(_, out)| !**out);
    kept.fold(DMatrix::zeros(n, n), |sum, (gram, _)| sum + gram)
}

/// The numbers of `point` as the stretches that are not `out` alone would have them: a step from where all of them lie,
/// where that is near, else a fit. The voltage that an unseen flight begins with is no part of what is judged, and
/// stays.
pub fn without(problem: &Problem, whitener: &Whitener, point: &FitPoint, grams: &Grams, out: &[bool]) -> Vec<f64> {
    let moving: Vec<usize> = (0..point.free.len()).filter(|&i| !begins(problem, point.free[i])).collect();
    let Some((x, expected)) = step(problem, point, &seen(grams, out), &moving) else { return point.x.clone() };
    let known = |cost: &[f64]| -> f64 { cost.iter().zip(out).filter(|(_, out)| !**out).map(|(c, _)| c).sum() };
    let gained = known(&point.cost) - known(&squares(problem, whitener, &x));
    if gained >= NEAR * expected {
        return x;
    }
    let free: Vec<usize> = moving.iter().map(|&i| point.free[i]).collect();
    fit(problem, &whitener.without(&problem.rows, out), &point.x, &free).x
}

/// A step of the numbers at `moving` by the inner products `gram` of the known stretches, and by how much it should
/// lower their whitened squares.
fn step(problem: &Problem, point: &FitPoint, gram: &DMatrix<f64>, moving: &[usize]) -> Option<(Vec<f64>, f64)> {
    let mut x = point.x.clone();
    let number = |i: usize| &problem.model.numbers[point.free[i]];
    let prior: Vec<f64> = moving.iter().map(|&i| number(i).trust.powi(-2)).collect();
    let inner = inverse(&Grams::pick(gram, moving, moving), &prior)?;
    let pull = |(row, &i): (usize, &usize)| {
        let k = point.free[i];
        gram[(i, point.free.len())] - prior[row] * (x[k] - problem.model.base[k])
    };
    let downhill = DMatrix::from_iterator(moving.len(), 1, moving.iter().enumerate().map(pull));
    let step = inner * &downhill;
    for (row, &i) in moving.iter().enumerate() {
        let n = number(i);
        x[point.free[i]] = (x[point.free[i]] + step[(row, 0)]).clamp(n.low, n.high);
    }
    Some((x, step.dot(&downhill)))
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

/// By which share the error rises from `before` to `after`, where it does beyond chance: by all that stretches of time
/// gain or lose, or, where it rises much, by the share of each, which three fast passes of a flight do not outweigh.
pub fn rise(before: &[f64], after: &[f64]) -> Option<f64> {
    let of = |unit: fn(f64, f64) -> f64| -> Vec<f64> {
        before.iter().zip(after).map(|(&b, &a)| (a - b) / unit(a, b).max(1e-300)).collect()
    };
    let [sum_before, sum_after] = [before, after].map(|x| x.iter().sum::<f64>());
    let by = (sum_after / sum_before.max(1e-300)).sqrt() - 1.0;
    let surely = |differences: &[f64]| deviations(differences) > WORSE_DEVIATIONS.get();
    let worse = by > WORSE_SHARE.get() && surely(&of(|_, _| 1.0));
    (worse || by > MUCH_WORSE_SHARE.get() && surely(&of(f64::max))).then_some(by)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_that_agree_are_two_deviations() {
        assert!((deviations(&[1.0; 4]) - 2.0).abs() < 1e-12);
        assert!(deviations(&[3.0, -1.0, -1.0, -1.0]).abs() < 1e-12);
    }

    #[test]
    fn worse_is_what_rises_everywhere_and_not_what_rises_once() {
        let before = [1.0; 20];
        assert!(rise(&before, &[1.1; 20]).is_some_and(|by| (by - 0.0488).abs() < 1e-3));
        let mut once = before;
        once[3] = 4.0;
        assert!(rise(&before, &once).is_none());
        let mut most = [1.1; 20];
        most[3] = 4.0;
        assert!(rise(&before, &most).is_some(), "one that rises much makes the others no less sure");
        assert!(rise(&before, &[1.01; 20]).is_none(), "half a percent of the error is nothing");
    }
}
