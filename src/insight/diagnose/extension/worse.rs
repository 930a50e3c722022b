//! Never worse: whether the extended model predicts unseen flight, all of it or a part, worse in any channel than the
//! vehicle that was given, or than the better of that and the compact model fitted to the same flights; and which
//! effect does it.

use crate::base::check::Check;
use crate::insight::diagnose::fitting::fit::{FitPoint, fit};
use crate::insight::diagnose::fitting::unseen::{parts, rise, seen, without};
use crate::insight::diagnose::fitting::whiten::Whitener;
use crate::insight::diagnose::judgement::pays::removed;
use crate::insight::diagnose::prediction::channels::{CHANNELS, NAMES, OF_VEHICLE, kind};
use crate::insight::diagnose::prediction::numbers::LOG_AT;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::fitted::FittedSelection;
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

/// What flights are without an extended model on unseen flight: as the vehicle that was given predicts them, and as the
/// compact model that is fitted to them does.
pub struct Unextended<'a> {
    pub problem: &'a Problem,
    given: Squares,
    compact: Squares,
    /// Whether the fitted one could fly.
    flies: bool,
}

impl<'a> Unextended<'a> {
    pub fn new(problem: &'a Problem, selection: &Selection) -> Self {
        let (whitener, compact) = (&selection.whitener, &selection.base);
        // Errors of the sensors and the voltage at the beginning are the flight's, not the vehicle's.
        let of_flight: Vec<usize> = compact.free.iter().copied().filter(|k| *k >= LOG_AT).collect();
        let mut x = compact.x.clone();
        x[..LOG_AT].copy_from_slice(&problem.model.base[..LOG_AT]);
        let given = fit(problem, whitener, &x, &of_flight);
        let flies = problem.model.vehicle_at(&compact.x).check().is_ok();
        let on_unseen = |point: &FitPoint| on_unseen(problem, whitener, point, &point.grams(problem, whitener));
        Self { problem, given: on_unseen(&given), compact: on_unseen(compact), flies }
    }

    /// Of channel `c` what is hardest to be no worse than: neither need be the better one in every part.
    fn squares(&self, c: usize, than: Than) -> &[f64] {
        let total = |squares: &Squares| squares[c].iter().sum::<f64>();
        let compact = than == Than::Either && self.flies && total(&self.compact) <= total(&self.given);
        if compact { &self.compact[c] } else { &self.given[c] }
    }
}

/// What `point` leaves in each part, fitted to the others.
fn on_unseen(problem: &Problem, whitener: &Whitener, point: &FitPoint, grams: &Grams) -> Squares {
    let mut sums = zeros(problem);
    for out in parts(problem) {
        let x = without(problem, whitener, point, grams, &out);
        add(problem, &mut sums, &problem.residuals(&problem.predict(&x)), &out);
    }
    sums
}

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

/// The channel that the extended model of `fitted` predicts worst, if it predicts any worse `than` the `reference`.
pub fn find(fitted: &FittedSelection, reference: &Unextended, than: Than) -> Option<Worse> {
    let problem = fitted.problem;
    let extended = on_unseen(problem, &fitted.selection.whitener, fitted.point(), &fitted.grams);
    // All unseen flight, then each part: what pays in two thirds may fail in the third.
    let mut spans = parts(problem);
    spans.insert(0, vec![true; problem.blocks]);
    spans.iter().find_map(|span| {
        let of =
            |squares: &[f64]| -> Vec<f64> { squares.iter().zip(span).filter(|(_, s)| **s).map(|(x, _)| *x).collect() };
        let rise = |c: usize| rise(&of(reference.squares(c, than)), &of(&extended[c]));
        let rises = OF_VEHICLE.into_iter().filter_map(|c| Some((c, rise(c)?)));
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
