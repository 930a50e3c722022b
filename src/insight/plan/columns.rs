//! By what a prediction can change, as columns: the numbers that are free beside any cause, and every cause.

use super::causes::Question;
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::channels::CHANNELS;
use crate::insight::diagnose::prediction::numbers::{BEGIN, span};
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use nalgebra::DVector;
use rayon::prelude::*;
use std::ops::Range;

/// The columns of every problem: numbers that are free beside any cause, the voltages that the flights begin with, the
/// numbers of each cause, and by what its prediction differs from the first one's.
pub struct CauseColumns {
    /// Numbers beside any cause; those of flights that are not in a problem are empty there.
    pub base: Vec<usize>,
    /// Numbers of the causes, and where those of each are among all columns.
    numbers: Vec<(usize, usize)>,
    pub own: Vec<Range<usize>>,
    causes: usize,
}

impl CauseColumns {
    pub fn new(question: &Question, simulated: usize, flown: usize) -> Self {
        let fixed = question.free.iter().copied().filter(|&k| k < BEGIN);
        let base: Vec<usize> = fixed.chain(BEGIN..BEGIN + flown + simulated).collect();
        let (mut numbers, mut own) = (Vec::new(), Vec::new());
        for (i, cause) in question.causes.iter().enumerate() {
            let from = base.len() + numbers.len();
            numbers.extend(cause.card.into_iter().flat_map(span).map(|k| (i, k)));
            own.push(from..base.len() + numbers.len());
        }
        CauseColumns { base, numbers, own, causes: question.causes.len() }
    }

    /// The number that a column is about; that of the first flight for all voltages.
    pub fn number(&self, column: usize) -> usize {
        let k = if column < self.base.len() { self.base[column] } else { self.numbers[column - self.base.len()].1 };
        k.min(BEGIN)
    }

    /// The difference of two causes' predictions.
    pub fn turn(&self, truth: usize, fitted: usize) -> DVector<f64> {
        let first = self.base.len() + self.numbers.len();
        let mut turn = DVector::zeros(first + self.causes);
        turn[first + truth] += 1.0;
        turn[first + fitted] -= 1.0;
        turn
    }

    /// The columns of a problem whose causes have the numbers `xs`, whitened; its flights come after `earlier` others.
    pub fn of(&self, problem: &Problem, whitener: &Whitener, xs: &[Vec<f64>], earlier: usize) -> Vec<ChannelValues> {
        let states: Vec<_> = xs.par_iter().map(|x| problem.predict(x)).collect();
        let empty = || -> ChannelValues { Default::default() };
        let flights = BEGIN + earlier..BEGIN + earlier + problem.records.len();
        let base = self.base.par_iter().map(|&k| {
            let place = if k < BEGIN { Some(k) } else { flights.contains(&k).then(|| k - earlier) };
            place.map_or(empty(), |k| problem.slope(&states[0], &xs[0], k))
        });
        let own = self.numbers.par_iter().map(|&(i, k)| problem.slope(&states[i], &xs[i], k));
        let first = problem.pick(&states[0]);
        let differences = states.par_iter().map(|state| {
            let mut values = problem.pick(state);
            for c in 0..CHANNELS {
                values[c].iter_mut().zip(&first[c]).for_each(|(value, first)| *value -= first);
            }
            values
        });
        let all = base.chain(own).chain(differences);
        all.map(|values| whitener.apply(&values, &problem.rows)).collect()
    }
}
