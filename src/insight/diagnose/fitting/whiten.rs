//! Noise of each channel: an autoregressive model of what is left when everything that could explain it is taken off,
//! and weights that outliers do not rule.

use crate::base::stats::robust_sd;
use crate::insight::criteria::evident::MOST_MEMORY;
use crate::insight::criteria::flown::NOISE_ROWS;
use crate::insight::diagnose::prediction::channels::CHANNELS;
use crate::insight::diagnose::prediction::problem::{ChannelValues, ResidualRow};
use crate::insight::estimate::autoregression::autoregression;
use crate::insight::estimate::gram::dot;
use crate::insight::estimate::robust::{capped, huber};
use rayon::prelude::*;

/// Order of the autoregressive model: rates and forces, turns and pushes, voltage.
const ORDER: [usize; 3] = [8, 3, 4];
/// Whitened residuals beyond so many standard deviations weigh less (Huber). Wider than identification's 3: an effect
/// that is rarely flown stands out of the noise as outliers do.
const HUBER: f64 = 3.5;
/// Rows are capped at so many standard deviations before their memory is fitted.
const CAP: f64 = 6.0;
/// Share of a direction that has to be new to be one of its own.
const LEAST_NEW: f64 = 1e-3;

/// Turns rows of residuals into independent ones of variance 1.
#[derive(Clone, Debug)]
pub struct Whitener {
    /// Coefficients of the past, newest first, and one over the standard deviation.
    filter: [(Vec<f64>, f64); CHANNELS],
    /// Square root of each row's weight; 0 leaves a row out.
    weight: ChannelValues,
    /// Directions of each channel's whitened rows that count for nothing, orthonormal.
    deaf: [Vec<Vec<f64>>; CHANNELS],
}

fn order(c: usize) -> usize {
    match c {
        0..6 => ORDER[0],
        6..12 => ORDER[1],
        _ => ORDER[2],
    }
}

impl Whitener {
    /// Scales channels only: before anything is known of their noise. An autoregression of residuals that still hold a
    /// slow effect would take the effect for noise.
    pub fn plain(residual: &ChannelValues, rows: &[Vec<ResidualRow>; CHANNELS]) -> Self {
        let filter = std::array::from_fn(|c| (Vec::new(), 1.0 / robust_sd(&residual[c]).max(1e-12)));
        let weigh = |c: usize| if rows[c].len() < NOISE_ROWS.count() { 0.0 } else { 1.0 };
        Whitener { filter, weight: std::array::from_fn(|c| vec![weigh(c); rows[c].len()]), deaf: Default::default() }
    }

    /// From residuals in which no structure is left. `other` is a unit for channels without any.
    pub fn of(noise: &ChannelValues, rows: &[Vec<ResidualRow>; CHANNELS]) -> Self {
        let filter = std::array::from_fn(|c| memory(&noise[c], &rows[c], order(c)));
        let weight = std::array::from_fn(|c| vec![1.0; rows[c].len()]);
        let mut out = Whitener { filter, weight, deaf: Default::default() };
        let white = out.apply(noise, rows);
        for c in 0..CHANNELS {
            let sd = robust_sd(&white[c]).max(1e-12);
            out.filter[c].1 /= sd;
            let weigh = |w: &f64| huber(w / sd, HUBER).sqrt();
            out.weight[c] = if rows[c].len() < NOISE_ROWS.count() {
                vec![0.0; rows[c].len()]
            } else {
                white[c].iter().map(weigh).collect()
            };
            // Where the filter has no past, a row is not white.
            let mut run = 0;
            for (i, row) in rows[c].iter().enumerate() {
                run = if row.follows { run + 1 } else { 0 };
                if run < order(c) {
                    out.weight[c][i] = 0.0;
                }
            }
        }
        out
    }

    /// Whitens values in the layout of the rows; a channel without values stays empty.
    pub fn apply(&self, x: &ChannelValues, rows: &[Vec<ResidualRow>; CHANNELS]) -> ChannelValues {
        std::array::from_fn(|c| self.channel(c, &x[c], &rows[c]))
    }

    fn channel(&self, c: usize, x: &[f64], rows: &[ResidualRow]) -> Vec<f64> {
        let (past, scale) = &self.filter[c];
        let mut run = 0;
        let one = |i: usize| {
            run = if rows[i].follows { run + 1 } else { 0 };
            let known = past.iter().take(run).enumerate();
            let expected: f64 = known.map(|(j, a)| a * x[i - 1 - j]).sum();
            (x[i] - expected) * scale * self.weight[c][i]
        };
        let mut white: Vec<f64> = (0..x.len()).map(one).collect();
        if !white.is_empty() {
            self.deaf[c].iter().for_each(|direction| remove(direction, &mut white));
        }
        white
    }

    /// The same, deaf to what `directions` of each channel's rows have beside the columns `heard`, which are whitened
    /// by this: whatever of it there is counts for nothing.
    pub fn deaf_to(
        self,
        directions: &[Vec<Vec<f64>>; CHANNELS],
        heard: &[ChannelValues],
        rows: &[Vec<ResidualRow>; CHANNELS],
    ) -> Self {
        let mut deaf: [Vec<Vec<f64>>; CHANNELS] = Default::default();
        deaf.par_iter_mut().enumerate().for_each(|(c, deaf)| {
            let of = |x: &Vec<f64>| self.channel(c, x, &rows[c]);
            let mut basis = Basis::default();
            heard.iter().filter(|column| !column[c].is_empty()).for_each(|column| basis.add(column[c].clone()));
            let first = basis.0.len();
            directions[c].iter().for_each(|direction| basis.add(of(direction)));
            *deaf = basis.0.split_off(first);
        });
        Self { deaf, ..self }
    }

    /// The same with the noise of each channel so many times as large.
    pub fn louder(mut self, times: &[f64; CHANNELS]) -> Self {
        self.filter.iter_mut().zip(times).for_each(|(filter, times)| filter.1 /= times);
        self
    }

    /// The same noise on the rows of other flights, none of them an outlier. Channels whose noise is not known are left
    /// out.
    pub fn on(&self, rows: &[Vec<ResidualRow>; CHANNELS]) -> Self {
        let weight = std::array::from_fn(|c| {
            let known = self.weight[c].iter().any(|w| *w > 0.0);
            let mut run = 0;
            let one = |row: &ResidualRow| {
                run = if row.follows { run + 1 } else { 0 };
                if known && run >= self.filter[c].0.len() { 1.0 } else { 0.0 }
            };
            rows[c].iter().map(one).collect()
        });
        Whitener { filter: self.filter.clone(), weight, deaf: Default::default() }
    }

    /// The same with outliers at their full weight.
    pub fn unweighted(&self) -> Self {
        let mut copy = self.clone();
        copy.weight.iter_mut().flatten().filter(|w| **w > 0.0).for_each(|w| *w = 1.0);
        copy
    }

    /// Square roots of the rows' weights.
    pub fn weights_mut(&mut self) -> &mut ChannelValues {
        &mut self.weight
    }

    /// Standard deviation of a channel's noise from sample to sample, in its unit.
    pub fn sd(&self, c: usize) -> f64 {
        1.0 / self.filter[c].1
    }
}

/// Directions of length 1, each at right angles to the others.
#[derive(Default)]
struct Basis(Vec<Vec<f64>>);

impl Basis {
    /// What `direction` has beside the others, if that is anything.
    fn add(&mut self, mut direction: Vec<f64>) {
        let before = norm(&direction);
        // Twice: once leaves rounding errors of what was taken off.
        (0..2).for_each(|_| self.0.iter().for_each(|known| remove(known, &mut direction)));
        let left = norm(&direction);
        if left > LEAST_NEW * before {
            direction.iter_mut().for_each(|x| *x /= left);
            self.0.push(direction);
        }
    }
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// Takes off `white` what it has of a direction of length 1.
fn remove(direction: &[f64], white: &mut [f64]) {
    let along = dot(direction, white);
    white.iter_mut().zip(direction).for_each(|(x, d)| *x -= along * d);
}

/// What of each row the rows before it tell, and one over the standard deviation of the rows.
fn memory(x: &[f64], rows: &[ResidualRow], order: usize) -> (Vec<f64>, f64) {
    // Outliers would make any noise look like a random walk.
    let found = autoregression(&capped(x, CAP, 0.0), |i| rows[i].follows, order);
    let mut past = found.past;
    // What measured flights leave is so slow that its whitening would discard everything slow, the causes with it.
    let memory: f64 = past.iter().sum();
    if memory > MOST_MEMORY.get() {
        past.iter_mut().for_each(|a| *a *= MOST_MEMORY.get() / memory);
    }
    (past, 1.0 / found.power.sqrt().max(1e-12))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deaf_to_a_direction_and_to_nothing_else() {
        let row = |i: u32| ResidualRow { flight: 0, index: i, block: 0, sample: i, follows: i > 0 };
        let mut rows: [Vec<ResidualRow>; CHANNELS] = Default::default();
        rows[0] = (0..400).map(row).collect();
        let turn = |i: i32| std::f64::consts::TAU * f64::from(i) / 400.0;
        let wave = |times: f64| -> Vec<f64> { (0..400).map(|i| (times * turn(i)).sin()).collect() };
        let of = |x: Vec<f64>| -> ChannelValues {
            let mut out: ChannelValues = Default::default();
            out[0] = x;
            out
        };
        let (slow, middle, fast) = (wave(5.0), wave(30.0), wave(80.0));
        let sum = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| 5.0 * a + b).collect() };
        let plain = Whitener::plain(&of(fast.clone()), &rows);
        let mut directions: [Vec<Vec<f64>>; CHANNELS] = Default::default();
        // The same once more is nothing new, and what is heard stays heard.
        directions[0] = vec![slow.clone(), slow.iter().map(|x| -2.0 * x).collect(), sum(&slow, &middle)];
        let heard = plain.apply(&of(middle.clone()), &rows);
        let deaf = plain.deaf_to(&directions, &[heard], &rows);
        assert_eq!(deaf.deaf[0].len(), 1);
        let white = |x: Vec<f64>| std::mem::take(&mut deaf.apply(&of(x), &rows)[0]);
        let (with, alone) = (white(sum(&slow, &fast)), white(fast));
        let apart = with.iter().zip(&alone).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let [alone, middle] = [alone, white(middle)].map(|x| norm(&x));
        assert!(apart < 1e-12 && alone > 13.0 && middle > 13.0, "{apart} {alone} {middle}");
    }
}
