//! What manoeuvres tell of two causes: what either leaves of the other where all other numbers make up for it as well
//! as they can.

use super::causes::Question;
use super::columns::CauseColumns;
use super::pair::{CausePair, Stretches, Way};
use super::simulate::{ManoeuvreFlights, PieceOf};
use crate::insight::diagnose::Diagnosed;
use crate::insight::estimate::gram::Grams;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Length of a stretch of time, s, up to which those of the flights so far are put together.
const STRETCH_S: f64 = 2.0;
/// Variance over squares of what noise adds to a stretch: to a difference of squares, and to a score.
const NOISE: [f64; 2] = [4.0, 1.0];
/// All pairs of the question.
pub fn pairs(diagnosed: &Diagnosed, question: &Question, simulation: &ManoeuvreFlights) -> Vec<CausePair> {
    let columns = CauseColumns::new(question, simulation.problem.records.len(), diagnosed.problem.records.len());
    let (problem, whitener) = (&diagnosed.problem, &diagnosed.selection.whitener);
    let xs: Vec<Vec<f64>> = question.causes.iter().map(|cause| cause.x.clone()).collect();
    let so_far = columns.of(problem, whitener, &xs, 0);
    let known = Grams::new(&so_far.iter().collect::<Vec<_>>(), &problem.rows, problem.blocks);
    let usable: f64 = problem.records.iter().map(|r| r.usable_s).sum();
    let together = (STRETCH_S * problem.blocks as f64 / usable.max(1.0)).round().max(1.0) as usize;
    let known: Vec<DMatrix<f64>> = known.blocks.chunks(together).map(summed).collect();
    let elsewhere = whitener.on(&simulation.problem.rows);
    let xs: Vec<Vec<f64>> = xs.iter().map(|x| simulation.numbers(x)).collect();
    let next = columns.of(&simulation.problem, &elsewhere, &xs, problem.records.len());
    let simulated = Grams::new(&next.iter().collect::<Vec<_>>(), &simulation.stretches, simulation.pieces.len());
    let is_cause = |i: usize| question.causes[i].card.is_some();
    let way = |truth: usize, fitted: usize| {
        let turn = columns.turn(truth, fitted);
        let rest: Vec<usize> = (0..columns.base.len()).chain(columns.own[fitted].clone()).collect();
        let trust = |column: &usize| problem.model.numbers[columns.number(*column)].trust.powi(-2);
        let stretches = |grams: Vec<&DMatrix<f64>>| {
            let each = grams.into_iter().map(|gram| reduced(gram, &rest, &turn)).collect();
            Stretches::new(each, rest.len() + 1)
        };
        let of = |piece: PieceOf| {
            let pieces = simulation.pieces.iter().zip(&simulated.blocks).filter(|(of, _)| **of == piece);
            stretches(pieces.map(|(_, gram)| gram).collect())
        };
        let kinds = simulation.kinds.iter().enumerate();
        Way {
            prior: rest.iter().map(trust).collect(),
            noise: NOISE[usize::from(!is_cause(fitted))],
            known: stretches(known.iter().collect()),
            around: of(PieceOf::Around),
            kinds: kinds.map(|(place, kind)| (of(PieceOf::Kind(place)), kind.times as f64)).collect(),
        }
    };
    let one = |&([i, j], wanted): &([usize; 2], f64)| {
        // Every cause can be nothing: only where it is there it shows.
        let ways = [[i, j], [j, i]].into_iter().filter(|[truth, _]| is_cause(*truth));
        CausePair { causes: [i, j], wanted, ways: ways.map(|[truth, fitted]| way(truth, fitted)).collect() }
    };
    question.pairs.par_iter().map(one).collect()
}

fn summed(grams: &[DMatrix<f64>]) -> DMatrix<f64> {
    let n = grams[0].nrows();
    grams.iter().fold(DMatrix::zeros(n, n), |sum, gram| sum + gram)
}

/// Inner products of the columns `rest` and of the combination `turn` of all.
fn reduced(gram: &DMatrix<f64>, rest: &[usize], turn: &DVector<f64>) -> DMatrix<f64> {
    let along = gram * turn;
    let n = rest.len();
    DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
        (true, true) => gram[(rest[i], rest[j])],
        (true, false) => along[rest[i]],
        (false, true) => along[rest[j]],
        (false, false) => along.dot(turn),
    })
}
