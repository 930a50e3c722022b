//! What manoeuvres tell of two causes: what either leaves of the other where all other numbers make up for it as well
//! as they can.

use super::causes::Question;
use super::simulate::{PieceOf, Simulation};
use crate::insight::diagnose::Diagnosed;
use crate::insight::diagnose::channels::CHANNELS;
use crate::insight::diagnose::numbers::{BEGIN, span};
use crate::insight::diagnose::problem::{ChannelValues, Problem};
use crate::insight::diagnose::whiten::Whitener;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Length of a stretch of time, s, up to which those of the flights so far are put together.
const STRETCH_S: f64 = 2.0;
/// Variance over squares of what noise adds to a stretch: to a difference of squares, and to a score.
const NOISE: [f64; 2] = [4.0, 1.0];
/// So often flown, what a manoeuvre does not tell it never does.
const EVER: f64 = 50.0;

/// Two causes, and what each stretch of time tells of them.
pub struct Pair {
    /// By their places in the question.
    pub causes: [usize; 2],
    pub wanted: f64,
    /// With the first taken for true and the second fitted, and the other way round where that tells anything.
    ways: Vec<Way>,
}

/// Inner products of the columns that make up for a difference, and of the difference, the last.
struct Way {
    prior: Vec<f64>,
    noise: f64,
    known: Vec<DMatrix<f64>>,
    /// By stretch of the simulation, with what it is of.
    simulated: Vec<(PieceOf, DMatrix<f64>)>,
    /// How often each kind was simulated.
    times: Vec<f64>,
}

impl Pair {
    /// Standard deviations over stretches of time by which the flights so far are expected to tell the two.
    pub fn so_far(&self) -> f64 {
        self.ways.iter().map(Way::so_far).fold(f64::INFINITY, f64::min)
    }

    /// The same of a flight with `counts` of each kind, beside which the flights so far only hold the other numbers:
    /// that they do not tell the two is known.
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
        self.told(&all, &next)
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

/// All pairs of the question.
pub fn pairs(diagnosed: &Diagnosed, question: &Question, simulation: &Simulation) -> Vec<Pair> {
    let columns = Columns::new(question, simulation.problem.records.len(), diagnosed.problem.records.len());
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
    let times: Vec<f64> = simulation.kinds.iter().map(|kind| kind.times as f64).collect();
    let is_cause = |i: usize| question.causes[i].card.is_some();
    let way = |truth: usize, fitted: usize| {
        let turn = columns.turn(truth, fitted);
        let rest: Vec<usize> = (0..columns.base.len()).chain(columns.own[fitted].clone()).collect();
        let trust = |column: &usize| problem.model.numbers[columns.number(*column)].trust.powi(-2);
        let reduced = |gram: &DMatrix<f64>| reduced(gram, &rest, &turn);
        Way {
            prior: rest.iter().map(trust).collect(),
            noise: NOISE[usize::from(!is_cause(fitted))],
            known: known.iter().map(reduced).collect(),
            simulated: simulation.pieces.iter().copied().zip(simulated.blocks.iter().map(reduced)).collect(),
            times: times.clone(),
        }
    };
    let one = |&([i, j], wanted): &([usize; 2], f64)| {
        // Every cause can be nothing: only where it is there it shows.
        let ways = [[i, j], [j, i]].into_iter().filter(|[truth, _]| is_cause(*truth));
        Pair { causes: [i, j], wanted, ways: ways.map(|[truth, fitted]| way(truth, fitted)).collect() }
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

/// The columns of every problem: numbers that are free beside any cause, the voltages that the flights begin with, the
/// numbers of each cause, and by what its prediction differs from the first one's.
struct Columns {
    /// Numbers beside any cause; those of flights that are not in a problem are empty there.
    base: Vec<usize>,
    /// Numbers of the causes, and where those of each are among all columns.
    numbers: Vec<(usize, usize)>,
    own: Vec<std::ops::Range<usize>>,
    causes: usize,
}

impl Columns {
    fn new(question: &Question, simulated: usize, flown: usize) -> Self {
        let fixed = question.free.iter().copied().filter(|&k| k < BEGIN);
        let base: Vec<usize> = fixed.chain(BEGIN..BEGIN + flown + simulated).collect();
        let (mut numbers, mut own) = (Vec::new(), Vec::new());
        for (i, cause) in question.causes.iter().enumerate() {
            let from = base.len() + numbers.len();
            numbers.extend(cause.card.into_iter().flat_map(span).map(|k| (i, k)));
            own.push(from..base.len() + numbers.len());
        }
        Columns { base, numbers, own, causes: question.causes.len() }
    }

    /// The number that a column is about; that of the first flight for all voltages.
    fn number(&self, column: usize) -> usize {
        let k = if column < self.base.len() { self.base[column] } else { self.numbers[column - self.base.len()].1 };
        k.min(BEGIN)
    }

    /// The difference of two causes' predictions.
    fn turn(&self, truth: usize, fitted: usize) -> DVector<f64> {
        let first = self.base.len() + self.numbers.len();
        let mut turn = DVector::zeros(first + self.causes);
        turn[first + truth] += 1.0;
        turn[first + fitted] -= 1.0;
        turn
    }

    /// The columns of a problem whose causes have the numbers `xs`, whitened; its flights come after `earlier` others.
    fn of(&self, problem: &Problem, whitener: &Whitener, xs: &[Vec<f64>], earlier: usize) -> Vec<ChannelValues> {
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
