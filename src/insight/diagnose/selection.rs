//! Which effects explain what is left: candidates, their rank, trials, and what is held.

pub mod accident;
pub mod begin;
pub mod candidates;
pub mod caused;
pub mod disambiguate;
pub mod fitted;
pub mod left_over;
pub mod lost;
pub mod ordinary;
pub mod rank;
pub mod reach;
pub mod select;
pub mod steady_air;
pub mod trial;
pub mod whole;

use super::fitting::fit::{self, FitPoint};
use super::fitting::whiten::Whitener;
use super::prediction::bends::is_form;
use super::prediction::numbers::span;
use super::prediction::problem::Problem;
use crate::model::effects::Card;
use candidates::Candidate;
use reach::Reach;

/// What selection ended with.
pub struct Selection {
    pub point: FitPoint,
    pub whitener: Whitener,
    /// Effects added, in the order of their gain when added, with those that nearly took their place.
    pub added: Vec<Added>,
    /// The fit of the compact model alone, under the same whitening.
    pub base: FitPoint,
    /// What the flights could show of each effect: beside all that is held, or of what is held beside the base.
    pub reach: Vec<Reach>,
    /// Causes that were not added.
    pub others: Vec<Candidate>,
}

impl Selection {
    /// The same with these numbers as the base vehicle has them, fitted again.
    pub fn with_given(self, problem: &Problem, numbers: &[usize]) -> Self {
        let mut free = self.point.free.clone();
        free.retain(|k| !numbers.contains(k));
        if free.len() == self.point.free.len() {
            return self;
        }
        let mut x = self.point.x.clone();
        numbers.iter().for_each(|&k| x[k] = problem.model.base[k]);
        Self { point: fit::fit(problem, &self.whitener, &x, &free), ..self }
    }

    /// The same without the effects `ids`, and without anything bent, which is no part of a vehicle; fitted again.
    pub fn without(&self, problem: &Problem, ids: &[&str]) -> Self {
        self.less(problem, ids, self.point.free.iter().copied().filter(|k| is_form(*k)).collect())
    }

    /// The same without the effects `ids`, fitted again.
    pub fn but(&self, problem: &Problem, ids: &[&str]) -> Self {
        self.less(problem, ids, Vec::new())
    }

    /// The same without the effects `ids` and the numbers `dropped`, fitted again.
    fn less(&self, problem: &Problem, ids: &[&str], mut dropped: Vec<usize>) -> Self {
        let gone = |a: &Added| ids.contains(&a.card.id);
        dropped.extend(self.added.iter().filter(|a| gone(a)).flat_map(|a| span(a.card)));
        let point = fit::fit_without(problem, &self.whitener, &self.point, &dropped);
        Self {
            point,
            whitener: self.whitener.clone(),
            added: self.added.iter().filter(|a| !gone(a)).cloned().collect(),
            base: self.base.clone(),
            reach: Vec::new(),
            others: Vec::new(),
        }
    }
}

/// An added effect.
#[derive(Clone, Debug)]
pub struct Added {
    pub card: &'static Card,
    pub ties: Vec<&'static Card>,
}
