//! Which effects explain the residuals: rank by score, refit the best and their rivals, keep the best, and again.

use super::fit::{self, Point};
use super::gram::{Grams, score};
use super::judge::is_material;
use super::model::{BEGIN, DISCHARGE, Stage, TAU, cards, span};
use super::problem::{Problem, Values};
use super::whiten::Whitener;
use crate::effects::{Card, Kind};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Most effects that are added.
const MOST: usize = 8;
/// Candidates refitted in a round, besides the rivals of the first.
const SHORT_LIST: usize = 6;
/// Least fall of the whitened squares, and least number of agreeing stretches, for a candidate to be added.
pub const GAIN: f64 = 30.0;
pub const EVIDENCE: f64 = 9.0;
/// Fall of the whitened squares for which even a few stretches are enough to be looked at.
const RARE: f64 = 100.0;
/// Fall of the whitened squares for which even an effect of no size that matters is added.
const NUISANCE: f64 = 400.0;
/// Rivals that come so near the best by standard deviations of their difference are a tie.
pub const TIE: f64 = 2.5;
/// Rivals compete where the one leaves at most this share of its gain to the other.
const COMPETES: f64 = 0.3;
/// Share of its information that a candidate keeps beside the base; below, the base absorbs it.
pub const ABSORBED: f64 = 2e-3;

/// A way to begin with an effect: numbers and their values.
#[derive(Clone, Debug)]
pub struct Direction {
    pub card: &'static Card,
    pub start: Vec<(usize, f64)>,
}

/// A direction with the change of the prediction that it makes, plain and whitened.
pub struct Column {
    direction: Direction,
    change: Values,
    white: Values,
}

impl Column {
    fn card(&self) -> &'static Card {
        self.direction.card
    }
}

/// An effect that was tried beside what stands.
pub struct Trial {
    pub card: &'static Card,
    pub point: Point,
    /// Fall of the whitened squares.
    pub gain: f64,
}

impl Trial {
    /// Gain; half of it where a number ends at the bound of its range, for then the effect stands in for something else.
    fn merit(&self, problem: &Problem) -> f64 {
        if self.bounded(problem) { 0.5 * self.gain } else { self.gain }
    }

    fn bounded(&self, problem: &Problem) -> bool {
        let at_end = |k: usize| {
            let (n, x) = (&problem.model.numbers[k], self.point.x[k]);
            x != 0.0 && (x <= n.low || x >= n.high)
        };
        span(self.card).any(at_end)
    }
}

/// What a log could show of an effect, before any residual is looked at.
#[derive(Clone, Debug)]
pub struct Reach {
    pub card: &'static Card,
    /// Information on the main parameter that the base leaves, and the share of all that it is.
    pub information: f64,
    pub kept: f64,
    /// The rival most like it, and how much (correlation of what is left).
    pub nearest: Option<(&'static str, f64)>,
}

/// What selection ended with.
pub struct Selection {
    pub point: Point,
    pub whitener: Whitener,
    /// Effects added, in the order of their gain when added, with those that nearly took their place.
    pub added: Vec<Added>,
    /// The fit of the compact model alone, under the same whitening.
    pub base: Point,
    pub reach: Vec<Reach>,
    /// Causes that were not added.
    pub others: Vec<Column>,
}

impl Selection {
    /// The same without the effects `ids`, fitted again.
    pub fn without(&self, problem: &Problem, ids: &[&str]) -> Self {
        let gone = |a: &Added| ids.contains(&a.card.id);
        let dropped: Vec<usize> = self.added.iter().filter(|a| gone(a)).flat_map(|a| span(a.card)).collect();
        let mut x = self.point.x.clone();
        dropped.iter().for_each(|&k| x[k] = 0.0);
        let free: Vec<usize> = self.point.free.iter().copied().filter(|k| !dropped.contains(k)).collect();
        Self {
            point: fit::fit(problem, &self.whitener, &x, &free),
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

/// The numbers of the compact model and of constant sensor errors that the flights tell anything about.
pub fn base_numbers(problem: &Problem) -> Vec<usize> {
    let biases = ["gyro_bias", "accel_bias"].into_iter().filter_map(crate::effects::card).flat_map(span);
    let volts = BEGIN..problem.model.numbers.len();
    let own = cards().flat_map(span).filter(|&k| problem.model.base[k] != 0.0);
    let mut all: Vec<usize> = (0..=DISCHARGE).chain(biases).chain(volts).chain(own).collect();
    all.sort_unstable();
    all.dedup();
    let state = problem.predict(&problem.model.base);
    all.retain(|&k| problem.model.numbers[k].high > problem.model.numbers[k].low);
    all.retain(|&k| !problem.slope(&state, &problem.model.base, k).iter().all(Vec::is_empty));
    all
}

/// Ways to begin with an effect: one size where it is linear, several where a large one looks unlike a small one.
pub fn directions(card: &'static Card) -> Vec<Direction> {
    let at = span(card);
    let sizes = |i: usize| {
        let [small, large] = card.parameters[i].typical;
        [small, (small * large).sqrt(), large]
    };
    let numbers: Vec<usize> = at.collect();
    let shape = card.parameters.iter().position(|p| p.name == "tau" && card.parameters.len() > 1);
    if let Some(shape) = shape {
        let [small, _, large] = sizes(shape);
        let grid = (0..4).map(|i| small * (large / small).powf(f64::from(i) / 3.0));
        let main = 1 - shape;
        return grid
            .map(|tau| Direction { card, start: vec![(numbers[main], sizes(main)[1]), (numbers[shape], tau)] })
            .collect();
    }
    if card.parameters.len() > 1 {
        return numbers.iter().enumerate().map(|(i, &k)| Direction { card, start: vec![(k, sizes(i)[0])] }).collect();
    }
    let signs: &[f64] = if card.parameters[0].low < 0.0 { &[1.0, -1.0] } else { &[1.0] };
    let shifts = card.kind == Kind::Timing || card.id == "propwash" || card.kind == Kind::Sensor;
    let wanted = if shifts { 4 - signs.len() } else { 1 };
    let sizes = sizes(0).into_iter().take(wanted);
    sizes
        .flat_map(|s| signs.iter().map(move |sign| sign * s))
        .map(|s| Direction { card, start: vec![(numbers[0], s)] })
        .collect()
}

/// Candidates: effects whose mean can be seen, that the base does not already hold.
pub fn candidates(problem: &Problem, held: &[&'static Card]) -> Vec<&'static Card> {
    let in_base = |card: &Card| span(card).any(|k| problem.model.base[k] != 0.0);
    let bias = |card: &Card| matches!(card.id, "gyro_bias" | "accel_bias");
    let one_clock = problem.records.iter().all(|r| r.one_clock);
    cards()
        .filter(|card| !(one_clock && card.id == "clock_skew"))
        .filter(|card| card.id != "gusts" && !bias(card) && !in_base(card))
        .filter(|card| held.iter().all(|h| h.id != card.id))
        .collect()
}

/// The columns of all directions; those that change nothing are left out.
fn columns(problem: &Problem, whitener: &Whitener, point: &Point, cards: &[&'static Card]) -> Vec<Column> {
    let mut all: Vec<Direction> = cards.iter().flat_map(|card| directions(card)).collect();
    if let Some(card) = cards.iter().find(|card| card.id == "clock_skew")
        && let Some(skew) = super::skew::estimate(problem, &point.state, &point.residual)
        && skew.abs() > 0.5 * card.parameters[0].typical[0]
    {
        // Nothing else would come near.
        all.retain(|d| d.card.id != card.id);
        all.push(Direction { card, start: vec![(span(card).start, skew)] });
    }
    let one = |d: Direction| {
        let change = problem.secant(&point.state, &point.x, &d.start, 1.0);
        let finite = change.iter().flatten().all(|x| x.is_finite());
        let white = whitener.apply(&change, &problem.rows);
        (finite && !change.iter().all(Vec::is_empty)).then_some(Column { direction: d, change, white })
    };
    all.into_par_iter().filter_map(one).collect()
}

/// The columns after the last of `held` was added: made anew where it moved in time or in voltage what they change, and of the causes that were tied with
/// it; else as they were.
fn renewed(
    problem: &Problem,
    whitener: &Whitener,
    point: &Point,
    held: &[&'static Card],
    tied: &[(&'static Card, f64)],
    mut found: Vec<Column>,
) -> Vec<Column> {
    let Some(last) = held.last() else { return found };
    found.retain(|c| c.card().id != last.id);
    let of = |card: &Card| span(card).map(|k| &problem.model.numbers[k]);
    let early = of(last).any(|n| n.stage <= Stage::Battery);
    let (rates, forces) = (of(last).any(|n| n.rates), of(last).any(|n| n.forces));
    let stale = |c: &Column| {
        early && of(c.card()).any(|n| rates && n.rates || forces && n.forces)
            || tied.iter().any(|(card, _)| card.id == c.card().id)
            || rivals(last, c.card())
    };
    found.par_iter_mut().filter(|c| stale(c)).for_each(|c| {
        let change = problem.secant(&point.state, &point.x, &c.direction.start, 1.0);
        if change.iter().flatten().all(|x| x.is_finite()) {
            c.white = whitener.apply(&change, &problem.rows);
            c.change = change;
        }
    });
    found
}

/// Adds effects until none is worth it.
pub fn select(problem: &Problem, watch: &mut dyn FnMut(&str, f64)) -> Selection {
    let free = base_numbers(problem);
    watch("fitting the base", 0.1);
    let plain = problem.residuals(&problem.predict(&problem.model.base));
    let mut whitener = Whitener::plain(&plain, &problem.rows);
    let base_state = problem.predict(&problem.model.base);
    let skewed = super::skew::estimate(problem, &base_state, &plain).is_some_and(|skew| skew.abs() > 5e-5);
    // Clocks that run apart leave nothing that a fit of the base could be about.
    let mut point = if skewed {
        fit::stay(problem, &whitener, &problem.model.base, &free)
    } else {
        fit::fit(problem, &whitener, &problem.model.base, &free)
    };
    let mut added: Vec<Added> = Vec::new();
    let mut reach = Vec::new();
    let mut pending: Vec<(&'static Card, f64)> = Vec::new();
    let mut found: Vec<Column> = Vec::new();
    for round in 0..=MOST {
        watch("weighing causes", 0.2 + 0.6 * round as f64 / MOST as f64);
        let held: Vec<&'static Card> = added.iter().map(|a| a.card).collect();
        found = if round == 0 {
            columns(problem, &whitener, &point, &candidates(problem, &held))
        } else {
            renewed(problem, &whitener, &point, &held, &pending, found)
        };
        // Noise is what is left when everything is taken off that any cause could explain.
        for _ in 0..if round == 0 { 2 } else { 1 } {
            whitener = saturated(problem, &whitener, &point, &found);
            point = if skewed && round == 0 {
                fit::stay(problem, &whitener, &point.x, &point.free)
            } else {
                fit::fit(problem, &whitener, &point.x, &point.free)
            };
            found.par_iter_mut().for_each(|c| c.white = whitener.apply(&c.change, &problem.rows));
        }
        let (scored, reached) = rank(problem, &whitener, &point, &found, round == 0);
        if round == 0 {
            reach = reached;
        }
        // What had the same gain for another reason has it still.
        if let Some(last) = added.last_mut() {
            let still = |card: &Card| {
                let gains = scored.iter().filter(|s| found[s.0].card().id == card.id).map(|s| s.1);
                gains.fold(0.0, f64::max)
            };
            last.ties =
                pending.drain(..).filter(|(card, gain)| still(card) < COMPETES * gain).map(|(card, _)| card).collect();
        }
        if round == MOST {
            break;
        }
        let mut trials = try_best(problem, &whitener, &point, &found, &scored);
        // Beside a rival that is already there, it would only take that one's place.
        trials.retain(|t| !(t.bounded(problem) && held.iter().any(|h| rivals(h, t.card))));
        let best_of = |material: bool| {
            let fitting = trials.iter().filter(|t| !material || is_material(t.card, &t.point.x));
            fitting.max_by(|a, b| a.merit(problem).total_cmp(&b.merit(problem)))
        };
        let Some(mut best) = best_of(false) else { break };
        // What is too small to matter is kept beside the causes only where it would stand in their way.
        if !is_material(best.card, &best.point.x) && best.gain < NUISANCE {
            match best_of(true) {
                Some(material) if material.gain >= GAIN => best = material,
                _ => break,
            }
        }
        if best.gain < GAIN {
            break;
        }
        let near = trials.iter().filter(|t| t.card.id != best.card.id && tied(best, t));
        pending = near.map(|t| (t.card, t.gain)).collect();
        added.push(Added { card: best.card, ties: Vec::new() });
        point = fit::fit(problem, &whitener, &best.point.x, &best.point.free);
    }
    let base = if added.is_empty() { point.clone() } else { fit::fit(problem, &whitener, &problem.model.base, &free) };
    Selection { point, whitener, added, base, reach, others: found }
}

fn rivals(a: &Card, b: &Card) -> bool {
    a.rivals.contains(&b.id) || b.rivals.contains(&a.id)
}

/// Whether a trial comes so near the best that their stretches of time do not decide.
fn tied(best: &Trial, other: &Trial) -> bool {
    let differences: Vec<f64> = other.point.cost.iter().zip(&best.point.cost).map(|(a, b)| a - b).collect();
    let sum: f64 = differences.iter().sum();
    let spread = differences.iter().map(|d| d * d).sum::<f64>().sqrt();
    other.gain > GAIN && sum < TIE * spread
}

/// The whitener of what is left when all columns are taken off.
fn saturated(problem: &Problem, whitener: &Whitener, point: &Point, found: &[Column]) -> Whitener {
    let residual = whitener.apply(&point.residual, &problem.rows);
    let all: Vec<&Values> = point.white.iter().chain(found.iter().map(|c| &c.white)).chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let Some((beta, _)) = together(&grams) else { return whitener.clone() };
    let mut left = point.residual.clone();
    let raw: Vec<Values> = point.free.par_iter().map(|&k| problem.slope(&point.state, &point.x, k)).collect();
    for (j, column) in raw.iter().chain(found.iter().map(|c| &c.change)).enumerate() {
        for (left, column) in left.iter_mut().zip(column) {
            left.iter_mut().zip(column).for_each(|(l, x)| *l -= beta[(j, 0)] * x);
        }
    }
    Whitener::of(&left, &problem.rows)
}

/// By how much the whitened squares of `point` would still fall if every number and every cause were fitted, less what that takes of the noise alone.
pub fn left_to_gain(problem: &Problem, whitener: &Whitener, point: &Point, selection: &Selection) -> f64 {
    let own = fit::whitened_slopes(problem, whitener, &point.state, &point.x, &selection.point.free);
    let causes: Vec<Values> = selection.others.par_iter().map(|c| whitener.apply(&c.change, &problem.rows)).collect();
    let residual = whitener.apply(&point.residual, &problem.rows);
    let all: Vec<&Values> = own.iter().chain(&causes).chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let Some((beta, n)) = together(&grams) else { return 0.0 };
    let along = Grams::pick(&grams.sum, &(0..n).collect::<Vec<_>>(), &[n]);
    ((beta.transpose() * along)[(0, 0)] - n as f64).max(0.0)
}

/// All columns of `grams` but the last, fitted to the last, and how many they are.
fn together(grams: &Grams) -> Option<(DMatrix<f64>, usize)> {
    let n = grams.sum.nrows() - 1;
    let own: Vec<usize> = (0..n).collect();
    let square = Grams::pick(&grams.sum, &own, &own);
    // Columns at several sizes of one effect are nearly the same: a small ridge decides among them.
    let ridge: Vec<f64> = (0..n).map(|i| 1e-4 * square[(i, i)] + 1e-12).collect();
    Some((super::gram::inverse(&square, &ridge)? * Grams::pick(&grams.sum, &own, &[n]), n))
}

/// Directions by the expected fall of the whitened squares, the best first; and what the log could show of each effect.
fn rank(
    problem: &Problem,
    whitener: &Whitener,
    point: &Point,
    found: &[Column],
    reach_too: bool,
) -> (Vec<(usize, f64, f64)>, Vec<Reach>) {
    let residual = whitener.apply(&point.residual, &problem.rows);
    let n = point.white.len();
    let all: Vec<&Values> = point.white.iter().chain(found.iter().map(|c| &c.white)).chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let rest: Vec<usize> = (0..n).collect();
    let mut prior: Vec<f64> = point.free.iter().map(|&k| problem.model.numbers[k].trust.powi(-2)).collect();
    prior.resize(all.len(), 0.0);
    let scores: Vec<_> =
        (0..found.len()).into_par_iter().map(|j| score(&grams, &rest, &[n + j], all.len() - 1, &prior)).collect();
    let mut order: Vec<(usize, f64, f64)> = Vec::new();
    for (j, s) in scores.iter().enumerate() {
        if let Some(s) = s
            && s.information[0] > ABSORBED * s.raw[0]
        {
            order.push((j, s.gain, s.evidence));
        }
    }
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut reach: Vec<Reach> = Vec::new();
    if !reach_too {
        return (order, reach);
    }
    for (j, s) in scores.iter().enumerate() {
        let (Some(s), card) = (s, found[j].card()) else { continue };
        if reach.iter().any(|r| r.card.id == card.id) {
            continue;
        }
        let size = found[j].direction.start[0].1;
        let (information, kept) = (s.information[0] / (size * size), s.information[0] / s.raw[0].max(1e-300));
        let near = |i: usize| {
            // Information on the first that the second leaves, as a share.
            let alone = s.information[0];
            let other = score(&grams, &[&rest[..], &[n + i]].concat(), &[n + j], all.len() - 1, &prior)?;
            Some((found[i].card().id, (1.0 - other.information[0] / alone).clamp(0.0, 1.0).sqrt()))
        };
        let rivals = (0..found.len()).filter(|&i| card.rivals.contains(&found[i].card().id));
        let nearest = rivals.filter_map(near).max_by(|a, b| a.1.total_cmp(&b.1));
        reach.push(Reach { card, information, kept, nearest });
    }
    (order, reach)
}

/// The time constants that a delay is mistaken for.
fn delayed(card: &Card) -> std::ops::Range<usize> {
    match card.id {
        "rate_delay" | "stream_offset" => TAU.start..TAU.start + 3,
        "yaw_delay" => TAU.start + 2..TAU.start + 3,
        "thrust_delay" => TAU.start + 3..TAU.end,
        _ => 0..0,
    }
}

/// Refits the first of the ranking, and the rivals of the very first.
fn try_best(
    problem: &Problem,
    whitener: &Whitener,
    point: &Point,
    found: &[Column],
    order: &[(usize, f64, f64)],
) -> Vec<Trial> {
    let mut chosen: Vec<usize> = Vec::new();
    for &(j, gain, evidence) in order {
        let card = found[j].card();
        let known = chosen.iter().any(|&i| found[i].card().id == card.id);
        let leader = chosen.first().map(|&i| found[i].card());
        let rival = leader.is_some_and(|l| rivals(l, card));
        if !known
            && gain > 0.5 * GAIN
            && (evidence > 0.5 * EVIDENCE || gain > RARE)
            && (chosen.len() < SHORT_LIST || rival)
        {
            chosen.push(j);
        }
    }
    let before = point.total();
    let from = |x: &[f64], card: &'static Card, start: &[(usize, f64)], shrink: f64| {
        let own: Vec<usize> = span(card).collect();
        let mut x = x.to_vec();
        own.iter().for_each(|&k| x[k] = 0.0);
        start.iter().for_each(|(k, value)| x[*k] = value * shrink);
        fit::refit(problem, whitener, point, &own, &x)
    };
    let refitted = |card, start: &[(usize, f64)], shrink| from(&point.x, card, start, shrink);
    // A lag that was fitted without its delay is too long by about that.
    let shortened = |card: &Card, delay: f64| {
        let mut x = point.x.clone();
        delayed(card).for_each(|k| x[k] = (x[k] - delay).max(0.3 * x[k]).max(problem.model.numbers[k].low));
        x
    };
    let one = |&j: &usize| {
        let Direction { card, start } = &found[j].direction;
        let mut best = refitted(card, start, 1.0);
        if best.total() > before {
            // Too far away: from a size too small to matter, downhill.
            best = refitted(card, start, 0.2 * card.parameters[0].typical[0] / start[0].1.abs());
        }
        if card.parameters[0].unit == "s" {
            // Late signals fit at more than one delay.
            let others = found.iter().enumerate().filter(|(i, c)| *i != j && c.card().id == card.id);
            let others = others.map(|(_, other)| refitted(card, &other.direction.start, 1.0));
            let beside =
                found.iter().map(|c| &c.direction).filter(|d| d.card.id == card.id && !delayed(card).is_empty());
            let beside = beside.map(|d| from(&shortened(card, d.start[0].1), card, &d.start, 1.0));
            for another in others.chain(beside) {
                if another.total() < best.total() {
                    best = another;
                }
            }
        }
        let gain = before - best.total();
        Trial { card, point: best, gain }
    };
    chosen.par_iter().map(one).collect()
}
