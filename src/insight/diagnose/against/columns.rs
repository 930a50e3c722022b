//! Columns of a linear comparison: what a difference adds to what both sets of flights show alike.

use super::suspect::Suspect;
use crate::insight::diagnose::fitting::fit::FitPoint;
use crate::insight::diagnose::fitting::score::{ScoreTest, score};
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::insight::diagnose::selection::candidates::{Candidate, Direction};
use crate::insight::estimate::gram::Grams;
use crate::model::effects::Card;
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Ridge of a cause in both sets, as a share of its own squares: the thrust curve may take it up, exactly, so that
/// nothing could be inverted.
const BESIDE_RIDGE: f64 = 1e-6;

/// A suspect in one direction: the score of its difference beside the same in both sets.
pub struct Tested {
    /// Place among the suspects.
    pub suspect: usize,
    /// Of an effect that is not held yet: how to begin with it.
    pub direction: Option<Direction>,
    pub score: ScoreTest,
    /// Difference that the score expects, in sizes of the direction.
    pub expected: f64,
}

/// What is tested, and beside what.
struct Test {
    suspect: usize,
    direction: Option<Direction>,
    /// The cause in both sets, where that is not held yet.
    beside: Option<usize>,
    /// The difference: columns, and whether only their later rows count.
    group: Vec<(usize, bool)>,
}

/// Tests every suspect that is not free yet. `candidates` are directions that nothing holds.
pub fn tests(
    problem: &Problem,
    whitener: &Whitener,
    point: &FitPoint,
    suspects: &[Suspect],
    candidates: &[Candidate],
) -> Vec<Tested> {
    let residual = whitener.apply(&point.residual, &problem.rows);
    let n = point.free.len();
    // What the thrust takes up, exactly, where both sets have it is tested like a number of the compact model.
    let alone = |card: &Card| card.about_full;
    let held = |s: &Suspect| s.card.is_none_or(alone) || s.numbers.clone().any(|k| point.free.contains(&k));
    let open = |s: &Suspect| s.own.iter().all(|k| !point.free.contains(k));
    let mut slopes: Vec<usize> = Vec::new();
    let mut all = Vec::new();
    for (suspect, s) in suspects.iter().enumerate().filter(|(_, s)| open(s)) {
        if held(s) {
            let group = s.own.iter().enumerate().map(|(i, _)| (n + slopes.len() + i, false)).collect();
            slopes.extend(&s.own);
            all.push(Test { suspect, direction: None, beside: None, group });
        }
    }
    for (j, candidate) in candidates.iter().enumerate() {
        let of = |s: &Suspect| s.card.is_some_and(|card| card.id == candidate.card().id);
        let Some(suspect) = suspects.iter().position(|s| of(s) && open(s) && !held(s)) else { continue };
        let column = n + slopes.len() + j;
        let direction = Some(candidate.direction.clone());
        all.push(Test { suspect, direction, beside: Some(column), group: vec![(column, true)] });
    }
    let slopes: Vec<ChannelValues> = problem
        .slopes(&point.state, &point.x, &slopes)
        .iter()
        .map(|slope| whitener.apply(slope, &problem.rows))
        .collect();
    let columns: Vec<&ChannelValues> =
        point.white.iter().chain(&slopes).chain(candidates.iter().map(|c| &c.white)).chain([&residual]).collect();
    let grams = Grams::new(&columns, &problem.rows, problem.blocks);
    let later = later(problem);
    let prior: Vec<f64> = point.free.iter().map(|&k| problem.model.numbers[k].trust.powi(-2)).collect();
    all.into_par_iter().filter_map(|test| tested(test, &grams, &later, &prior)).collect()
}

/// Whether each stretch of time is of a later flight.
pub fn later(problem: &Problem) -> Vec<bool> {
    // What is not of the earlier set.
    problem.sets().swap_remove(0)
}

/// The score of one test. What both sets show alike comes first among the columns.
fn tested(test: Test, grams: &Grams, later: &[bool], prior: &[f64]) -> Option<Tested> {
    let rest: Vec<(usize, bool)> = (0..prior.len()).chain(test.beside).map(|i| (i, false)).collect();
    let residual = (grams.sum.nrows() - 1, false);
    let columns: Vec<(usize, bool)> = rest.iter().chain(&test.group).copied().chain([residual]).collect();
    let own = masked(grams, later, &columns);
    let mut prior = prior.to_vec();
    prior.extend(test.beside.map(|_| BESIDE_RIDGE * own.sum[(prior.len(), prior.len())]));
    prior.resize(columns.len(), 0.0);
    let places: Vec<usize> = (0..rest.len()).collect();
    let group: Vec<usize> = (rest.len()..columns.len() - 1).collect();
    if group.iter().any(|&i| own.sum[(i, i)] <= 0.0) {
        return None;
    }
    let score = score(&own, &places, &group, columns.len() - 1, &prior)?;
    let u: f64 = score.blocks.iter().map(|(_, u)| u[(0, 0)]).sum();
    let expected = u / score.information[0].max(1e-300);
    Some(Tested { suspect: test.suspect, direction: test.direction, score, expected })
}

/// Products of columns, of which some count in later stretches only.
fn masked(grams: &Grams, later: &[bool], columns: &[(usize, bool)]) -> Grams {
    let n = columns.len();
    let one = |(gram, later): (&DMatrix<f64>, &bool)| {
        DMatrix::from_fn(n, n, |a, b| {
            let ((i, x), (j, y)) = (columns[a], columns[b]);
            if (x || y) && !later { 0.0 } else { gram[(i, j)] }
        })
    };
    let blocks: Vec<DMatrix<f64>> = grams.blocks.iter().zip(later).map(one).collect();
    let sum = blocks.iter().fold(DMatrix::zeros(n, n), |sum, gram| sum + gram);
    Grams { blocks, sum }
}
