//! Noise of each channel: an autoregressive model of what is left when everything that could explain it is taken off,
//! and weights that outliers do not rule.

use super::channels::CHANNELS;
use super::problem::{ChannelValues, ResidualRow};
use crate::base::stats::robust_sd;
use crate::insight::criteria::evident::MOST_MEMORY;
use crate::insight::criteria::flown::NOISE_ROWS;
use crate::insight::estimate::autoregression::autoregression;
use crate::insight::estimate::robust::{capped, huber};

/// Order of the autoregressive model: rates and forces, turns and pushes, voltage.
const ORDER: [usize; 3] = [8, 3, 4];
/// Whitened residuals beyond so many standard deviations weigh less (Huber). Wider than identification's 3: an effect
/// that is rarely flown stands out of the noise as outliers do.
const HUBER: f64 = 3.5;
/// Rows are capped at so many standard deviations before their memory is fitted.
const CAP: f64 = 6.0;

/// Turns rows of residuals into independent ones of variance 1.
#[derive(Clone, Debug)]
pub struct Whitener {
    /// Coefficients of the past, newest first, and one over the standard deviation.
    filter: [(Vec<f64>, f64); CHANNELS],
    /// Square root of each row's weight; 0 leaves a row out.
    weight: ChannelValues,
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
        Whitener { filter, weight: std::array::from_fn(|c| vec![weigh(c); rows[c].len()]) }
    }

    /// From residuals in which no structure is left. `other` is a unit for channels without any.
    pub fn of(noise: &ChannelValues, rows: &[Vec<ResidualRow>; CHANNELS]) -> Self {
        let filter = std::array::from_fn(|c| memory(&noise[c], &rows[c], order(c)));
        let mut out = Whitener { filter, weight: std::array::from_fn(|c| vec![1.0; rows[c].len()]) };
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
        std::array::from_fn(|c| {
            let (past, scale) = &self.filter[c];
            let mut run = 0;
            let one = |i: usize| {
                run = if rows[c][i].follows { run + 1 } else { 0 };
                let known = past.iter().take(run).enumerate();
                let expected: f64 = known.map(|(j, a)| a * x[c][i - 1 - j]).sum();
                (x[c][i] - expected) * scale * self.weight[c][i]
            };
            (0..x[c].len()).map(one).collect()
        })
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
        Whitener { filter: self.filter.clone(), weight }
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
