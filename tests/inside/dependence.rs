//! Whatever number changes beside whatever other: what the diagnosis computes again is all of the prediction that
//! changes.

use crate::truth::Vehicle;
use crate::truth::hidden::{Setting, Style, fly};
use racer::insight::diagnose::prediction::numbers::span;
use racer::insight::diagnose::prediction::problem::{ChannelValues, Problem};
use racer::insight::quality::check;
use racer::model::effects::{self, Card};
use rayon::prelude::*;

/// A flight of so many seconds.
fn flight(style: Style, seconds: f64) -> Problem {
    let vehicle = Vehicle::draw(51);
    let setting = Setting { seed: 51, seconds, noise: 1.0, imu_hz: 200.0, style };
    let log = fly(&vehicle, &[], &setting);
    racer::insight::diagnose::problem(vec![check(&log)], &vehicle.in_racer())
}

/// `x` with number `k` moved as far as matters. A form without its size would be none: it gets one.
fn moved(problem: &Problem, x: &[f64], k: usize) -> Vec<f64> {
    let mut out = x.to_vec();
    let number = &problem.model.numbers[k];
    out[k] = (x[k] + 20.0 * number.step).clamp(number.low, number.high);
    let of = |i: &usize, card: &Card| span(card).start + i == k;
    let is_form = |card: &&Card| card.shape.iter().chain(card.forms).any(|i| of(i, card));
    if let Some(card) = effects::cards().find(is_form) {
        out[span(card).start] = card.parameters[0].typical[1];
    }
    out
}

/// The channels in which two predictions differ by more than a millionth of the largest reading: whenever a command
/// arrives, of thrust too, the integration of the rates begins a new part, which changes their last digits.
fn differ(a: &ChannelValues, b: &ChannelValues, measured: &ChannelValues) -> Vec<usize> {
    let scale = |c: usize| measured[c].iter().fold(0.0, |most: f64, m| most.max(m.abs()));
    let off = |c: usize| a[c].iter().zip(&b[c]).any(|(a, b)| (a - b).abs() > 1e-6 * scale(c));
    (0..a.len()).filter(|&c| a[c].len() != b[c].len() || off(c)).collect()
}

#[test]
fn what_is_computed_again_is_all_that_changes() {
    let problem = flight(Style::Race, 10.0);
    assert!(problem.rows.iter().all(|rows| rows.len() > 10), "every channel is there");
    let base = &problem.model.base;
    let count = base.len();
    let stale = |a: usize| -> Vec<String> {
        let x = moved(&problem, base, a);
        let state = problem.predict(&x);
        let beside = |b: usize| {
            let y = moved(&problem, &x, b);
            let which: Vec<usize> = (0..count).filter(|&k| y[k] != x[k]).collect();
            let again = problem.pick(&problem.change(&state, &which, &y));
            let whole = problem.pick(&problem.predict(&y));
            let wrong = differ(&again, &whole, &problem.measured);
            let name = |k: usize| &problem.model.numbers[k].name;
            (!wrong.is_empty()).then(|| format!("{} beside {}: channels {wrong:?}", name(b), name(a)))
        };
        (0..count).filter_map(beside).collect()
    };
    let stale: Vec<String> = (0..count).into_par_iter().flat_map_iter(stale).collect();
    assert!(stale.is_empty(), "{} of {} pairs are stale:\n{}", stale.len(), count * count, stale.join("\n"));
}

/// The comparison would see it: every number that an effect of the mean has changes the prediction of a race or of an
/// excitation flight (a race hardly yaws), beyond what is called the same.
#[test]
fn every_number_changes_the_prediction() {
    let flights = [flight(Style::Race, 10.0), flight(Style::Excited, 60.0)];
    let seen = |problem: &Problem, k: usize, typical: f64| {
        let base = &problem.model.base;
        let mut x = moved(problem, base, k);
        // A limit shows where it is reached.
        x[k] = x[k].max(typical);
        let mut without = x.clone();
        without[k] = base[k];
        let [changed, plain] = [&x, &without].map(|x| problem.pick(&problem.predict(x)));
        !differ(&changed, &plain, &problem.measured).is_empty()
    };
    for card in effects::cards().filter(|card| !card.writes.is_empty()) {
        for (k, parameter) in span(card).zip(card.parameters) {
            let large = parameter.typical[1];
            let name = &flights[0].model.numbers[k].name;
            assert!(flights.iter().any(|flight| seen(flight, k, large)), "{name} changes nothing");
        }
    }
}
