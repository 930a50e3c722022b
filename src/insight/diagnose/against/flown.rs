//! Functions of what is flown: what a model may get wrong.

use crate::insight::diagnose::prediction::channels::{CHANNELS, FORCE, TURN};
use crate::insight::diagnose::prediction::problem::{Problem, ResidualRow};
use crate::insight::diagnose::selection::Selection;
use rayon::prelude::*;

/// What was flown so long ago may still act on a rate or on the thrust, s.
const RATE_LAGS_S: [f64; 9] = [0.0, 0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.18, 0.26];
const THRUST_LAGS_S: [f64; 6] = [0.0, 0.01, 0.02, 0.04, 0.08, 0.16];

/// Functions of what is flown, at the rows of each channel of the vehicle. Sensors answer to kinematics alone.
pub fn directions(problem: &Problem, selection: &Selection) -> [Vec<Vec<f64>>; CHANNELS] {
    let all: Vec<Vec<Vec<f64>>> = (0..CHANNELS).into_par_iter().map(|c| of_channel(problem, selection, c)).collect();
    all.try_into().expect("as many as there are channels")
}

fn of_channel(problem: &Problem, selection: &Selection, c: usize) -> Vec<Vec<f64>> {
    let flown = FlownRows { problem, selection, c };
    let mut all = match c {
        0..FORCE => flown.turning(c),
        FORCE..TURN => flown.pushed(c - FORCE),
        _ => Vec::new(),
    };
    all.iter_mut().flatten().for_each(|x| *x = if x.is_finite() { *x } else { 0.0 });
    all
}

/// What is flown at the rows of a channel.
struct FlownRows<'a> {
    problem: &'a Problem,
    selection: &'a Selection,
    c: usize,
}

impl FlownRows<'_> {
    /// A signal by flight and sample, so long before each row.
    fn at(&self, before_s: f64, of: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let one = |row: &ResidualRow| {
            let flight = row.flight as usize;
            let before = (before_s / self.problem.records[flight].period_s).round() as usize;
            of(flight, (row.sample as usize).saturating_sub(before))
        };
        self.problem.rows[self.c].iter().map(one).collect()
    }

    fn rate(&self, k: usize, before_s: f64) -> Vec<f64> {
        self.at(before_s, |f, i| self.selection.point.state[f].rates[i][k])
    }

    fn throttle(&self, before_s: f64) -> Vec<f64> {
        self.at(before_s, |f, i| self.selection.point.state[f].thrust(i))
    }

    fn voltage(&self) -> Vec<f64> {
        self.at(0.0, |f, i| self.selection.point.state[f].modelled_v[i])
    }

    fn velocity(&self, k: usize) -> Vec<f64> {
        self.at(0.0, |f, i| self.problem.records[f].velocity[k][i])
    }

    /// Of the rate about axis `k`.
    fn turning(&self, k: usize) -> Vec<Vec<f64>> {
        let own = RATE_LAGS_S.map(|lag| self.rate(k, lag));
        let others = [(k + 1) % 3, (k + 2) % 3];
        let mut all: Vec<Vec<f64>> = own.to_vec();
        all.extend([0, 2, 4, 6].map(|lag| own[lag].iter().map(|w| w * w.abs()).collect()));
        all.extend([0, 4].map(|lag| own[lag].iter().map(|w| w * w * w).collect()));
        all.extend(others.into_iter().flat_map(|k| [0.0, 0.05].map(|lag| self.rate(k, lag))));
        all.push(times(&self.rate(others[0], 0.0), &self.rate(others[1], 0.0)));
        let throttle = self.throttle(0.02);
        all.extend([0, 2, 4, 6].map(|lag| times(&own[lag], &throttle)));
        all.extend([0, 4].map(|lag| times(&own[lag], &self.voltage())));
        all.extend((0..3).map(|k| self.velocity(k)));
        all.extend([throttle, self.throttle(0.08)]);
        all
    }

    /// Of the specific force along axis `k`.
    fn pushed(&self, k: usize) -> Vec<Vec<f64>> {
        let v: [Vec<f64>; 3] = std::array::from_fn(|k| self.velocity(k));
        let across: Vec<f64> = v[0].iter().zip(&v[1]).map(|(x, y)| x.hypot(*y)).collect();
        let speed: Vec<f64> = across.iter().zip(&v[2]).map(|(a, z)| a.hypot(*z)).collect();
        let throttle = THRUST_LAGS_S.map(|lag| self.throttle(lag));
        let rates: [Vec<f64>; 3] = std::array::from_fn(|k| self.rate(k, 0.0));
        let squared = |x: &[f64]| -> Vec<f64> { x.iter().map(|x| x * x.abs()).collect() };
        let mut all: Vec<Vec<f64>> = v.to_vec();
        all.extend([squared(&v[k]), times(&speed, &v[k]), times(&across, &v[2]), times(&across, &across)]);
        all.extend([times(&throttle[0], &v[k]), times(&throttle[0], &v[2]), across]);
        all.extend(rates.clone());
        all.extend([times(&rates[0], &rates[1]), times(&rates[1], &rates[2]), times(&rates[2], &rates[0])]);
        all.extend([times(&rates[0], &rates[0]), times(&rates[1], &rates[1]), times(&rates[2], &rates[2])]);
        all.extend((0..3).map(|k| self.rate(k, 0.03)));
        all.extend([0, 3].map(|lag| times(&throttle[lag], &throttle[lag])));
        all.push(times(&throttle[0], &times(&throttle[0], &throttle[0])));
        all.push(times(&throttle[0], &self.voltage()));
        all.extend(throttle);
        all
    }
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}
