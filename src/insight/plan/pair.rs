//! Two causes, and how surely flights tell the one from the other.

use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use nalgebra::{DMatrix, DVector};

/// So often flown, what a manoeuvre does not tell it never does.
const EVER: f64 = 50.0;

/// Two causes, and what each stretch of time tells of them.
pub struct CausePair {
    /// By their places in the question.
    pub causes: [usize; 2],
    pub wanted: f64,
    /// With the first taken for true and the second fitted, and the other way round where that tells anything.
    pub ways: Vec<Way>,
}

/// What the stretches of some flight hold: inner products of the columns that make up for a difference of two causes,
/// and of the difference, the last.
pub struct Stretches {
    each: Vec<DMatrix<f64>>,
    sum: DMatrix<f64>,
}

impl Stretches {
    /// Of matrices with `size` columns.
    pub fn new(each: Vec<DMatrix<f64>>, size: usize) -> Self {
        let sum = each.iter().fold(DMatrix::zeros(size, size), |sum, gram| sum + gram);
        Stretches { each, sum }
    }
}

/// One of two causes taken for true, and the other fitted.
pub struct Way {
    /// One over the variance that each of the columns is known with beforehand.
    pub prior: Vec<f64>,
    /// Variance over squares of what noise adds to a stretch.
    pub noise: f64,
    /// Of the flights so far.
    pub known: Stretches,
    /// Of take-off and landing.
    pub around: Stretches,
    /// Of each kind, and how often it was simulated.
    pub kinds: Vec<(Stretches, f64)>,
}

impl CausePair {
    /// Standard deviations over stretches of time by which the flights so far are expected to tell the two.
    pub fn so_far(&self) -> f64 {
        self.ways.iter().map(Way::so_far).fold(f64::INFINITY, f64::min)
    }

    /// The same of a flight with `counts` of each kind: by itself, for that the flights so far do not tell the two is
    /// known, and together with them, for a few stretches of theirs may outweigh all others.
    pub fn planned(&self, counts: &[f64]) -> f64 {
        self.ways.iter().map(|way| way.planned(counts)).fold(f64::INFINITY, f64::min)
    }

    /// Whether any number of manoeuvres tells them.
    pub fn is_ever_told(&self, kinds: usize) -> bool {
        self.planned(&vec![EVER; kinds]) > self.wanted
    }

    /// Why a flight does not tell them.
    pub fn why_not(&self, kinds: usize) -> &'static str {
        if self.is_ever_told(kinds) {
            return "it takes more than one flight";
        }
        "the same in every manoeuvre of the pilot, within the noise of these sensors"
    }
}

impl Way {
    fn so_far(&self) -> f64 {
        let left = self.left(&self.known.sum);
        left.map_or(0.0, |left| self.deviations(self.squares(&left, &self.known, 1.0)))
    }

    fn planned(&self, counts: &[f64]) -> f64 {
        let flown = || self.kinds.iter().zip(counts).filter(|(_, n)| **n > 0.0).map(|((of, times), n)| (of, n / times));
        let mut sum = &self.known.sum + &self.around.sum;
        flown().for_each(|(of, weight)| sum.zip_apply(&of.sum, |s, g| *s += weight * g));
        let Some(left) = self.left(&sum) else { return 0.0 };
        let around = self.squares(&left, &self.around, 1.0);
        let next = flown().fold(around, |all, (of, weight)| plus(all, self.squares(&left, of, weight)));
        let together = plus(next, self.squares(&left, &self.known, 1.0));
        self.deviations(next).min(self.deviations(together))
    }

    /// What is left of the difference where the columns make up for it as well as they can, by the inner products of
    /// all that is flown.
    fn left(&self, sum: &DMatrix<f64>) -> Option<DVector<f64>> {
        let n = self.prior.len();
        let rest: Vec<usize> = (0..n).collect();
        let inner = inverse(&Grams::pick(sum, &rest, &rest), &self.prior)?;
        let made_up = inner * Grams::pick(sum, &rest, &[n]);
        Some(DVector::from_fn(n + 1, |i, _| if i < n { -made_up[(i, 0)] } else { 1.0 }))
    }

    /// The sum of what stretches tell, and of its squares, each so many times.
    fn squares(&self, left: &DVector<f64>, of: &Stretches, weight: f64) -> [f64; 2] {
        let one = |gram: &DMatrix<f64>| {
            let told = (gram * left).dot(left).max(0.0);
            [weight * told, weight * told * told]
        };
        of.each.iter().map(one).fold([0.0; 2], plus)
    }

    fn deviations(&self, [told, squares]: [f64; 2]) -> f64 {
        told / (squares + self.noise * told).sqrt().max(1e-300)
    }
}

fn plus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two columns that are alike so far, and apart in the only kind of manoeuvre.
    fn pair(stretches: usize) -> CausePair {
        let alike = DMatrix::from_element(2, 2, 100.0);
        let apart = DMatrix::from_diagonal_element(2, 2, 100.0);
        let of = |gram: &DMatrix<f64>, n: usize| Stretches::new(vec![gram.clone(); n], 2);
        let kinds = vec![(of(&apart, stretches), 1.0)];
        let (known, around) = (of(&alike, 20), Stretches::new(Vec::new(), 2));
        let way = Way { prior: vec![1e-6], noise: 4.0, known, around, kinds };
        CausePair { causes: [0, 1], wanted: 3.0, ways: vec![way] }
    }

    #[test]
    fn what_is_alike_so_far_is_told_by_the_manoeuvre_that_tells_it() {
        let pair = pair(2);
        assert!(pair.so_far() < 0.1, "{}", pair.so_far());
        let [few, many] = [2.0, 20.0].map(|count| pair.planned(&[count]));
        assert!(few > 1.0 && many > 3.0 && many > few, "{few} {many}");
        // Every stretch of the same size: as many standard deviations as the root of their number.
        assert!(many < 40.0_f64.sqrt());
        assert!(pair.is_ever_told(1));
    }
}
