//! Whether what is left of the force swings: a load on a line, a loose battery, a frame that rings. No signal of the
//! moment tells that, because a swing remembers; but half a period later it has the other sign, and after a whole one
//! its own again, which gusts and wrong drag never have.

use crate::insight::criteria::replicated::{OSCILLATION_AWAY, OSCILLATION_BACK, OSCILLATION_LASTS};
use crate::insight::diagnose::prediction::channels::FORCE;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Problem, ResidualRow};
use crate::insight::diagnose::prediction::record::BIN_S;
use crate::insight::estimate::robust::capped;
use std::ops::RangeInclusive;

/// Residuals are capped at so many standard deviations.
const CAP: f64 = 6.0;
/// Half periods that are looked for, in bins: 10 Hz to 0.8 Hz.
const HALF: RangeInclusive<usize> = 5..=60;
/// What a swing is called, by its frequency, Hz.
const TONES: [(f64, &str); 7] = [
    (0.9, "a swing near 0.9 Hz"),
    (1.3, "a swing near 1.3 Hz"),
    (1.9, "a swing near 1.9 Hz"),
    (2.8, "a swing near 2.8 Hz"),
    (4.0, "a swing near 4 Hz"),
    (6.0, "a swing near 6 Hz"),
    (9.0, "a swing near 9 Hz"),
];

/// Whether a signal that structure lines up with is a swing.
pub fn is_swing(along: &str) -> bool {
    TONES.iter().any(|tone| tone.1 == along)
}

/// Something that swings along a body axis: how much of the residual's power it is, and its name.
#[derive(Clone, Copy, Debug)]
pub struct Oscillation {
    pub axis: usize,
    pub share: f64,
    pub name: &'static str,
}

/// What swings in the residual of the specific force.
pub fn find(problem: &Problem, residual: &ChannelValues) -> Vec<Oscillation> {
    let one = |axis: usize| {
        let (share, name) = swing(&residual[FORCE + axis], &problem.rows[FORCE + axis], problem.blocks)?;
        Some(Oscillation { axis, share, name })
    };
    (0..3).filter_map(one).collect()
}

/// Share of the residual's power that swings, and what the swing is called.
fn swing(residual: &[f64], rows: &[ResidualRow], blocks: usize) -> Option<(f64, &'static str)> {
    let y = capped(residual, CAP, 0.0);
    // Products with what was so many bins before, by stretch of time.
    let products = |lag: usize| {
        let mut sums = vec![0.0; blocks];
        for i in lag..rows.len() {
            if rows[i].flight == rows[i - lag].flight && rows[i].index == rows[i - lag].index + lag as u32 {
                sums[rows[i].block as usize] += y[i] * y[i - lag];
            }
        }
        sums
    };
    let sum = |lag: usize| products(lag).iter().sum::<f64>();
    let half = HALF.map(|lag| (lag, sum(lag))).min_by(|a, b| a.1.total_cmp(&b.1))?.0;
    let [first, second] = [half, 2 * half].map(products);
    let agree = |blocks: &[f64], sign: f64| {
        let sum = sign * blocks.iter().sum::<f64>();
        sum.max(0.0).powi(2) / blocks.iter().map(|b| b * b).sum::<f64>().max(1e-300)
    };
    let (away, back) = (-first.iter().sum::<f64>(), second.iter().sum::<f64>());
    let agreed = agree(&first, -1.0) > OSCILLATION_AWAY.get() && agree(&second, 1.0) > OSCILLATION_BACK.get();
    let swings = agreed && back > OSCILLATION_LASTS.get() * away;
    let hz = 0.5 / (half as f64 * BIN_S);
    let near = |tone: &(f64, &str)| (tone.0 / hz).ln().abs();
    let name = TONES.into_iter().min_by(|a, b| near(a).total_cmp(&near(b)))?.1;
    swings.then(|| (away / sum(0).max(1e-300), name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};

    /// A residual that remembers: white noise through a filter of second order, with more white noise on top.
    fn remembered(first: f64, second: f64, share: f64) -> (Vec<f64>, Vec<ResidualRow>) {
        let mut noise = Philox::new(7).sequence(RngStream::Pilot, 0, 0);
        let (mut before, mut now) = (0.0, 0.0);
        let mut white = move || noise.uniform([-1.0, 1.0]);
        let one = |_| {
            (before, now) = (now, first * now + second * before + white());
            share * now + white()
        };
        let y: Vec<f64> = (0..30_000).map(one).collect();
        let row = |i: u32| ResidualRow { flight: 0, index: i, block: i / 200, sample: i, follows: i > 0 };
        (y, (0..30_000).map(row).collect())
    }

    #[test]
    fn a_swing_is_told_from_gusts() {
        // Poles at 1.3 Hz with a damping ratio of 0.08; a gust that fades in half a second.
        let (omega, damping) = (std::f64::consts::TAU * 1.3 * BIN_S, 0.08f64);
        let radius = (-damping * omega).exp();
        let (y, rows) =
            remembered(2.0 * radius * (omega * (1.0 - damping * damping).sqrt()).cos(), -radius * radius, 0.03);
        let (share, name) = swing(&y, &rows, 150).expect("a swing");
        assert!(name == "a swing near 1.3 Hz" && share > 0.03, "{name}: {share}");
        let (y, rows) = remembered(0.98, 0.0, 0.2);
        assert!(swing(&y, &rows, 150).is_none());
    }
}
