//! How far thrust and drag have moved against the base vehicle, and how much of that one effect accounts for, by itself
//! or beside what a base vehicle is off by without a cause.

use crate::insight::criteria::Criterion;
use crate::insight::criteria::drifted::{
    CAUSE_ACCOUNTS, CAUSE_BESIDE, CAUSE_NEEDED, COMPENSATED, MOVED_DEVIATIONS, MOVED_THRUST,
};
use crate::insight::criteria::material::MATERIAL_SIZE;
use crate::insight::diagnose::prediction::numbers::is_force;
use crate::insight::diagnose::selection::caused::ForceCause;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use nalgebra::{DMatrix, DVector};

/// What a base vehicle is off by: the part of the voltage in its thrust, and its thrust. Up to these shares without a
/// cause.
static ERRORS: [&Criterion; 2] = [&COMPENSATED, &MOVED_THRUST];

/// How much of the move an effect accounts for, with what the base is off by, and with which size.
pub struct Account {
    pub way: ForceCause,
    /// Up to which the base may be off beside it.
    pub limits: [f64; 2],
    pub share: f64,
    pub size: f64,
    /// Standard deviation of the size.
    pub sd: f64,
}

/// The move of the numbers of thrust and drag, and what it does to the residuals.
pub struct Moved {
    /// Their places among the fitted numbers.
    main: Vec<usize>,
    by: DVector<f64>,
    /// Whitened squares of a move of theirs, where all other numbers make up for it.
    metric: DMatrix<f64>,
    covariance: DMatrix<f64>,
    /// Their moves where the base is off by all of each.
    errors: [DVector<f64>; 2],
    /// Inverse of the information on all fitted numbers.
    everything: DMatrix<f64>,
}

/// What leaves least of the move.
struct Least {
    size: f64,
    sd: f64,
    off: [f64; 2],
    /// Whitened squares.
    left: f64,
}

/// Whether an effect of that size and standard deviation is there, and anybody would notice.
pub fn is_sure(way: ForceCause, size: f64, sd: f64) -> bool {
    let p = &way.card.parameters[0];
    let worth = if way.about_full { COMPENSATED.get() } else { MATERIAL_SIZE.get() * p.typical[0] };
    // Of the other sign it would be no effect: no thrust comes back with time.
    size >= p.low && size.abs() > worth && size.abs() > MOVED_DEVIATIONS.get() * sd
}

impl Moved {
    /// Of a fit; `sum` holds the inner products of what its numbers change, whitened.
    pub fn new(fitted: &FittedSelection, sum: &DMatrix<f64>) -> Option<Self> {
        let (numbers, base) = (&fitted.problem.model.numbers, &fitted.problem.model.base);
        let (free, x) = (&fitted.selection.point.free, &fitted.selection.point.x);
        let own: Vec<usize> = (0..free.len()).collect();
        let (main, rest): (Vec<usize>, Vec<usize>) = own.iter().partition(|i| is_force(free[**i]));
        let prior = |which: &[usize]| -> Vec<f64> { which.iter().map(|&i| numbers[free[i]].trust.powi(-2)).collect() };
        let inner = inverse(&Grams::pick(sum, &rest, &rest), &prior(&rest))?;
        let cross = Grams::pick(sum, &rest, &main);
        let metric = Grams::pick(sum, &main, &main) - cross.transpose() * &inner * &cross;
        let from_base =
            |x: &[f64]| DVector::from_iterator(main.len(), main.iter().map(|&i| x[free[i]] - base[free[i]]));
        let errors = [[1.0, 0.0], [0.0, 1.0]].map(|off| {
            let mut x = base.clone();
            fitted.problem.model.off(&mut x, off);
            from_base(&x)
        });
        let by = from_base(x);
        let covariance = Grams::pick(&fitted.covariance, &main, &main);
        let everything = inverse(&Grams::pick(sum, &own, &own), &prior(&own))?;
        Some(Self { main, by, metric, covariance, errors, everything })
    }

    /// What the effect of column `c` beside the fitted numbers accounts for, by itself or with what a base is off by
    /// without a cause; none where it is too little, its size is not sure, or nobody would notice.
    pub fn account(&self, way: ForceCause, sum: &DMatrix<f64>, c: usize) -> Option<Account> {
        let n = self.everything.nrows();
        let absorbed = &self.everything * Grams::pick(sum, &(0..n).collect::<Vec<_>>(), &[n + c]);
        let direction = DVector::from_iterator(self.main.len(), self.main.iter().map(|&i| absorbed[(i, 0)]));
        let alone = self.least(Some(&direction), [0.0; 2])?;
        let limits = if self.share(&alone) >= CAUSE_ACCOUNTS.get() { [0.0; 2] } else { ERRORS.map(Criterion::get) };
        let least = if limits == [0.0; 2] { alone } else { self.beside(way, &direction, limits)? };
        let way = ForceCause { off: least.off, ..way };
        let account = Account { way, limits, share: self.share(&least), size: least.size, sd: least.sd };
        is_sure(way, least.size, least.sd).then_some(account)
    }

    /// The effect of a `direction` beside errors of the base up to `limits`, which is worth more than these, and needed
    /// beside them.
    fn beside(&self, way: ForceCause, direction: &DVector<f64>, limits: [f64; 2]) -> Option<Least> {
        let without = self.least(None, limits)?;
        // What turns the voltage itself has no other turn of it beside it.
        let own = if way.card.about_full { [0.0, limits[1]] } else { limits };
        let with = self.least(Some(direction), own)?;
        let worth = self.squares(&(direction * with.size)) > self.squares(&(&self.errors[0] * limits[0]));
        let needed = with.left < (1.0 - CAUSE_NEEDED.get()) * without.left;
        (worth && needed && self.share(&with) >= CAUSE_BESIDE.get()).then_some(with)
    }

    /// The share that a change of thrust alone, in proportion, accounts for: that is no effect.
    pub fn in_proportion(&self, limits: [f64; 2]) -> f64 {
        self.least(Some(&self.errors[1]), [limits[0], 0.0]).map_or(0.0, |least| self.share(&least))
    }

    fn share(&self, least: &Least) -> f64 {
        1.0 - least.left / self.squares(&self.by).max(1e-300)
    }

    fn squares(&self, by: &DVector<f64>) -> f64 {
        by.dot(&(&self.metric * by))
    }

    /// The size of `direction` that leaves least of the move, where the base is off by up to `limits`.
    fn least(&self, direction: Option<&DVector<f64>>, limits: [f64; 2]) -> Option<Least> {
        let ends = [-1.0, 0.0, 1.0];
        let pairs = ends.iter().flat_map(|a| ends.iter().map(move |b| [*a, *b]));
        pairs.filter_map(|at| self.at(direction, limits, at)).min_by(|a, b| a.left.total_cmp(&b.left))
    }

    /// The same where each of what the base is off by is at its lower end, between its ends, or at its upper end.
    fn at(&self, direction: Option<&DVector<f64>>, limits: [f64; 2], at: [f64; 2]) -> Option<Least> {
        let mut off: [f64; 2] = std::array::from_fn(|e| at[e] * limits[e]);
        let rest = &self.by - &self.errors[0] * off[0] - &self.errors[1] * off[1];
        let between: Vec<usize> = (0..2).filter(|&e| at[e] == 0.0 && limits[e] > 0.0).collect();
        let columns: Vec<DVector<f64>> =
            direction.into_iter().chain(between.iter().map(|&e| &self.errors[e])).cloned().collect();
        if columns.is_empty() {
            return Some(Least { size: 0.0, sd: 0.0, off, left: self.squares(&rest) });
        }
        let columns = DMatrix::from_columns(&columns);
        let metric = &self.metric * &columns;
        let weight = &metric * inverse(&(columns.transpose() * &metric), &vec![0.0; columns.ncols()])?;
        let sizes = weight.transpose() * &rest;
        let first = columns.ncols() - between.len();
        between.iter().enumerate().for_each(|(i, &e)| off[e] = sizes[first + i]);
        if between.iter().any(|&e| off[e].abs() > limits[e]) {
            return None;
        }
        let variance = weight.transpose() * &self.covariance * &weight;
        let own = |value: f64| if first > 0 { value } else { 0.0 };
        let (size, sd) = (own(sizes[0]), own(variance[(0, 0)].max(0.0).sqrt()));
        Some(Least { size, sd, off, left: self.squares(&(&rest - &columns * &sizes)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::effects;

    /// Four flights in rotorpy had a mass of 0.0001 to 0.02 of itself, with 0.3 to 2.9 standard deviations.
    #[test]
    fn what_is_small_or_not_sure_is_no_cause() {
        let way = effects::cards().flat_map(ForceCause::of).find(|way| !way.about_full).expect("one");
        let typical = way.card.parameters[0].typical[0];
        assert!(is_sure(way, typical, 0.1 * typical));
        assert!(!is_sure(way, 0.02 * typical, 0.001 * typical), "small");
        assert!(!is_sure(way, typical, 0.4 * typical), "not sure");
        let full = effects::cards().filter(|card| card.about_full).flat_map(ForceCause::of).find(|way| way.about_full);
        assert!(!is_sure(full.expect("one"), 0.5 * COMPENSATED.get(), 0.0), "what a base vehicle may be off by");
    }
}
