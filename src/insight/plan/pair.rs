//! Two causes, and how surely flights tell the one from the other.

use super::simulate::PieceOf;
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

/// Inner products of the columns that make up for a difference, and of the difference, the last.
pub struct Way {
    /// One over the variance that each of those columns is known with beforehand.
    pub prior: Vec<f64>,
    /// Variance over squares of what noise adds to a stretch.
    pub noise: f64,
    /// Of the flights so far, by stretch.
    pub known: Vec<DMatrix<f64>>,
    /// By stretch of the simulation, with what it is of.
    pub simulated: Vec<(PieceOf, DMatrix<f64>)>,
    /// How often each kind was simulated.
    pub times: Vec<f64>,
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
        let known: Vec<(f64, &DMatrix<f64>)> = self.known.iter().map(|gram| (1.0, gram)).collect();
        self.told(&known, &known)
    }

    fn planned(&self, counts: &[f64]) -> f64 {
        let weight = |of: &PieceOf| match of {
            PieceOf::Kind(place) => counts[*place] / self.times[*place],
            PieceOf::Around => 1.0,
            PieceOf::Nothing => 0.0,
        };
        let next = self.simulated.iter().map(|(of, gram)| (weight(of), gram)).filter(|(w, _)| *w > 0.0);
        let next: Vec<(f64, &DMatrix<f64>)> = next.collect();
        let all: Vec<(f64, &DMatrix<f64>)> = self.known.iter().map(|gram| (1.0, gram)).chain(next.clone()).collect();
        self.told(&all, &next).min(self.told(&all, &all))
    }

    /// What the stretches `judged` tell where the numbers are those that suit all of `fitted` best; each so many times.
    fn told(&self, fitted: &[(f64, &DMatrix<f64>)], judged: &[(f64, &DMatrix<f64>)]) -> f64 {
        let n = self.prior.len();
        let mut sum = DMatrix::zeros(n + 1, n + 1);
        fitted.iter().for_each(|(w, gram)| sum.zip_apply(*gram, |s, g| *s += w * g));
        let rest: Vec<usize> = (0..n).collect();
        let Some(inner) = inverse(&Grams::pick(&sum, &rest, &rest), &self.prior) else { return 0.0 };
        let made_up = inner * Grams::pick(&sum, &rest, &[n]);
        let left = DVector::from_fn(n + 1, |i, _| if i < n { -made_up[(i, 0)] } else { 1.0 });
        let (mut told, mut variance) = (0.0, 0.0);
        for (w, gram) in judged {
            let squares = (*gram * &left).dot(&left).max(0.0);
            told += w * squares;
            variance += w * (squares * squares + self.noise * squares);
        }
        told / variance.sqrt().max(1e-300)
    }
}
