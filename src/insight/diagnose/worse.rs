//! Never worse: whether the extended model predicts unseen flight, all of it or a part, worse in any channel than the
//! vehicle that was given, or than the better of that and the compact model fitted to the same flights; and which
//! effect does it.

use super::channels::{CHANNELS, NAMES, OF_VEHICLE, kind};
use super::fit::FitPoint;
use super::fitted::FittedSelection;
use super::numbers::LOG_AT;
use super::pays::removed;
use super::problem::{ChannelValues, Problem};
use super::unseen::{parts, rise, seen, without};
use crate::base::check::Check;
use crate::insight::estimate::gram::Grams;
use crate::model::effects::{Card, EffectKind, MODEL, ResidualChannel};

/// A channel that is predicted worse on unseen flight.
pub struct Worse {
    /// Its place among the channels.
    pub number: usize,
    pub channel: &'static str,
    /// Share by which its error rises.
    pub by: f64,
    /// Whether it does over all unseen flight, not only in a part.
    pub whole: bool,
    /// The effect without which it rises least, if any is to blame.
    pub blamed: Option<&'static Card>,
}

/// What an extended model is held against.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Than {
    /// The vehicle that was given.
    Given,
    /// In each channel the better of that and the compact model fitted to the same flights.
    Either,
}

/// Squares of the residuals of each channel, by stretch of time, on unseen flight.
type Squares = Vec<Vec<f64>>;

fn zeros(problem: &Problem) -> Squares {
    vec![vec![0.0; problem.blocks]; CHANNELS]
}

/// Adds what `residual` has in stretches that are `out`.
fn add(problem: &Problem, sums: &mut Squares, residual: &ChannelValues, out: &[bool]) {
    for c in 0..CHANNELS {
        for (row, r) in problem.rows[c].iter().zip(&residual[c]) {
            let block = row.block as usize;
            if out[block] {
                sums[c][block] += r * r;
            }
        }
    }
}

/// The channel that the extended model of `fitted` predicts worst, if it predicts any worse `than` those; `base` is the
/// compact model fitted.
pub fn find(fitted: &FittedSelection, base: &FitPoint, than: Than) -> Option<Worse> {
    let problem = fitted.problem;
    let whitener = &fitted.selection.whitener;
    let white = whitener.apply(&base.residual, &problem.rows);
    let columns: Vec<&ChannelValues> = base.white.iter().chain([&white]).collect();
    let grams = Grams::new(&columns, &problem.rows, problem.blocks);
    let (mut extended, mut compact, mut given) = (zeros(problem), zeros(problem), zeros(problem));
    for out in parts(problem) {
        let tried = |sums: &mut Squares, x: &[f64]| {
            let residual = problem.residuals(&problem.predict(x));
            add(problem, sums, &residual, &out);
        };
        tried(&mut extended, &without(problem, whitener, fitted.point(), &fitted.grams, &out));
        let fitted_base = without(problem, whitener, base, &grams, &out);
        tried(&mut compact, &fitted_base);
        // Errors of the sensors and the voltage at the beginning are the flight's, not the vehicle's.
        let mut as_given = fitted_base;
        as_given[..LOG_AT].copy_from_slice(&problem.model.base[..LOG_AT]);
        tried(&mut given, &as_given);
    }
    // What one would go on with otherwise: of both the better one, where the fitted one could fly. Neither need be that
    // in every part.
    let total = |squares: &Squares, c: usize| squares[c].iter().sum::<f64>();
    let alone = than == Than::Given || problem.model.vehicle_at(&base.x).check().is_err();
    let reference = |c: usize| if alone || total(&given, c) < total(&compact, c) { &given } else { &compact };
    // All unseen flight, then each part: what pays in two thirds may fail in the third.
    let mut spans = parts(problem);
    spans.insert(0, vec![true; problem.blocks]);
    spans.iter().find_map(|span| {
        let of =
            |squares: &[f64]| -> Vec<f64> { squares.iter().zip(span).filter(|(_, s)| **s).map(|(x, _)| *x).collect() };
        let rises = OF_VEHICLE.into_iter().filter_map(|c| Some((c, rise(&of(&reference(c)[c]), &of(&extended[c]))?)));
        let (c, by) = rises.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let whole = span.iter().all(|s| *s);
        Some(Worse { number: c, channel: NAMES[c].0, by, whole, blamed: blamed(fitted, c, span) })
    })
}

/// The effect of the simulator that acts on channel `c` and without which that has the least error on unseen flight in
/// the `span`, less than with it.
fn blamed(fitted: &FittedSelection, c: usize, span: &[bool]) -> Option<&'static Card> {
    let (problem, whitener) = (fitted.problem, &fitted.selection.whitener);
    let total = |x: &[f64], out: &[bool]| {
        let mut sums = zeros(problem);
        add(problem, &mut sums, &problem.residuals(&problem.predict(x)), out);
        sums[c].iter().zip(span).filter(|(_, s)| **s).map(|(x, _)| x).sum::<f64>()
    };
    let pushed = |card: &Card| kind(c) == ResidualChannel::Force && card.kind == EffectKind::Battery;
    let acts = |card: &&Card| card.channels.contains(&kind(c)) || pushed(card);
    let held = |card: &&Card| !fitted.places(card).is_empty();
    let cards: Vec<&'static Card> = MODEL.into_iter().filter(acts).filter(held).collect();
    let mut saved = vec![0.0; cards.len()];
    for out in parts(problem) {
        let x = without(problem, whitener, fitted.point(), &fitted.grams, &out);
        let gram = seen(&fitted.grams, &out);
        let with = total(&x, &out);
        for (card, saved) in cards.iter().zip(&mut saved) {
            let [_, moved] = removed(fitted, &gram, &fitted.places(card), &x);
            *saved += with - total(&moved, &out);
        }
    }
    let best = cards.into_iter().zip(saved).max_by(|a, b| a.1.total_cmp(&b.1));
    best.filter(|(_, saved)| *saved > 0.0).map(|(card, _)| card)
}
