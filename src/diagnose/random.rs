//! Effects of chance: they have no mean, or one that looks like another effect's, and show in the variance.

use super::finding::{Finding, Status, Value};
use super::predict::{FORCE, RATE};
use super::problem::Problem;
use super::select::Selection;
use crate::effects::{self, Card};
use crate::stats::{mean, robust_sd};
use std::collections::BTreeMap;

/// Stretches of flight that have to agree.
const REPLICATED: f64 = 15.0;
/// Smallest gust that is worth a word, m/s2.
const LEAST_GUST: f64 = 0.08;
/// Lags between which the memory of gusts is looked for, in bins.
const LAGS: [usize; 2] = [6, 18];

/// What the variance of the rates says about lost commands: the share that is lost, and the stretches that agree.
#[derive(Clone, Copy, Debug)]
pub struct Lost {
    pub share: f64,
    pub stretches: f64,
}

/// The variance of the rate residuals, against what single lost commands would add to it.
pub fn lost_commands(problem: &Problem, selection: &Selection) -> Lost {
    let mut blocks = vec![[0.0; 2]; problem.blocks];
    let point = &selection.point;
    for axis in 0..3 {
        let (rows, residual) = (&problem.rows[RATE + axis], &point.residual[RATE + axis]);
        if rows.len() < 100 {
            continue;
        }
        let noise = robust_sd(residual).powi(2);
        let energy = energy(problem, &point.x, axis);
        let expected: Vec<f64> = rows.iter().map(|row| energy[row.flight as usize][row.index as usize]).collect();
        let middle = mean(&expected);
        for (i, row) in rows.iter().enumerate() {
            // Weights of the best estimate for a share of a percent or so.
            let weight = 1.0 / (noise + 0.02 * expected[i]).powi(2);
            let b = &mut blocks[row.block as usize];
            b[0] += weight * (expected[i] - middle).max(0.0) * (residual[i].powi(2) - noise);
            b[1] += weight * (expected[i] - middle).max(0.0) * expected[i];
        }
    }
    let (top, bottom): (f64, f64) = (blocks.iter().map(|b| b[0]).sum(), blocks.iter().map(|b| b[1]).sum());
    let slope = top / bottom.max(1e-300);
    let squares: f64 = blocks.iter().map(|b| b[0] * b[0]).sum();
    let share = if slope > 0.0 { 0.5 - (0.25 - slope.min(0.24)).sqrt() } else { 0.0 };
    Lost { share, stretches: if top > 0.0 { top * top / squares.max(1e-300) } else { 0.0 } }
}

/// Sum over the commands of the squared error that losing each would leave in each bin, (rad/s)2.
fn energy(problem: &Problem, x: &[f64], axis: usize) -> Vec<Vec<f64>> {
    let p = problem.model.parameters(x);
    let late = crate::dynamics::extended::lateness(&p).rates;
    let tau = x[super::model::TAU.start + axis];
    let one = |record: &super::record::Record| {
        let mut out = vec![0.0; record.bins.len()];
        let middles: Vec<f64> = record.bins.iter().map(|b| 0.5 * (record.time[b[0]] + record.time[b[1] - 1])).collect();
        for pair in record.sent.windows(2) {
            let (before, now) = (pair[0], pair[1]);
            let change = (now.1[axis] - before.1[axis]) * p.max_rate[axis];
            if change.abs() < 1e-3 {
                continue;
            }
            let (begin, held) = (now.0 + late, now.0 - before.0);
            let first = middles.partition_point(|t| *t < begin);
            for (bin, t) in middles.iter().enumerate().skip(first).take_while(|(_, t)| **t < begin + held + 5.0 * tau) {
                let since = t - begin;
                let rise = |t: f64| if t > 0.0 { 1.0 - (-t / tau).exp() } else { 0.0 };
                out[bin] += (change * (rise(since) - rise(since - held))).powi(2);
            }
        }
        out
    };
    problem.records.iter().map(one).collect()
}

/// Whether the rates are noisier after stick movements as they are where commands get lost, and by a share that matters. Lost commands also delay, on average;
/// a delay that is much longer is one of its own.
pub fn are_lost(lost: &Lost, card: &Card) -> bool {
    lost.stretches >= REPLICATED && lost.share > 0.5 * card.parameters[0].typical[0]
}

/// Gusts: specific force that the model does not predict, with a memory of a tenth of a second or more, on both horizontal axes.
pub fn gusts(problem: &Problem, selection: &Selection, structure_rms: f64) -> Option<Finding> {
    let card: &'static Card = effects::card("gusts")?;
    let mut lags = [[0.0; 2]; 2];
    let mut agree = [0.0; 2];
    let mut blocks_all: Vec<[f64; 2]> = vec![[0.0; 2]; problem.blocks];
    for axis in 0..2 {
        let (rows, residual) = (&problem.rows[FORCE + axis], &selection.point.residual[FORCE + axis]);
        if rows.len() < 1000 {
            return None;
        }
        let cap = 6.0 * robust_sd(residual);
        let y = |i: usize| residual[i].clamp(-cap, cap);
        for (which, lag) in LAGS.into_iter().enumerate() {
            let mut blocks = vec![0.0; problem.blocks];
            let mut n = 0.0;
            for i in lag..rows.len() {
                if rows[i].index - rows[i - lag].index == lag as u32 && rows[i].flight == rows[i - lag].flight {
                    blocks[rows[i].block as usize] += y(i) * y(i - lag);
                    n += 1.0;
                }
            }
            let sum: f64 = blocks.iter().sum();
            lags[axis][which] = sum / n;
            blocks.iter().zip(&mut blocks_all).for_each(|(b, all)| all[which] += b / n);
            if which == 0 {
                agree[axis] =
                    if sum > 0.0 { sum * sum / blocks.iter().map(|b| b * b).sum::<f64>().max(1e-300) } else { 0.0 };
            }
        }
    }
    let both = |which: usize| 0.5 * (lags[0][which] + lags[1][which]);
    let stretches = agree[0].min(agree[1]);
    let (near, far) = (both(0), both(1).max(1e-9));
    let bin = super::record::BIN_S;
    let apart = (LAGS[1] - LAGS[0]) as f64 * bin;
    let tau = apart / (near / far).max(1.02).ln();
    let sigma = (near.max(0.0) * (LAGS[0] as f64 * bin / tau).exp()).sqrt();
    let balanced = lags[0][0].min(lags[1][0]) > 0.15 * lags[0][0].max(lags[1][0]);
    if stretches < REPLICATED || sigma < LEAST_GUST || !balanced || tau < 0.05 || structure_rms > 0.7 * sigma {
        return None;
    }
    let n = problem.blocks as f64;
    let spread = |which: usize| {
        let m = mean(&blocks_all.iter().map(|b| b[which]).collect::<Vec<_>>());
        (blocks_all.iter().map(|b| (b[which] - m).powi(2)).sum::<f64>() * n / (n - 1.0)).sqrt() * 0.5
    };
    let half = 1.96 * 0.5 * sigma * spread(0) / near;
    let half_tau = 1.96 * tau * tau / apart * (spread(0) / near).hypot(spread(1) / far);
    let value = |v: f64, h: f64, unit: &str| Value { value: v, low: v - h, high: v + h, unit: unit.into() };
    let (manoeuvre, kinds) = card.manoeuvre;
    Some(Finding {
        effect: card.id,
        name: card.name,
        status: Status::Named,
        members: vec![card.id],
        sentence: card.sentence,
        channel: "specific force x",
        parameters: BTreeMap::from([
            ("sigma".to_string(), value(sigma, half, "m/s2")),
            ("tau".to_string(), value(tau, half_tau, "s")),
        ]),
        stretches,
        explained: BTreeMap::new(),
        gain: BTreeMap::new(),
        impact: sigma * (2.0 * tau.min(1.0) * 1.0).sqrt(),
        rivals: card.rivals.to_vec(),
        manoeuvre,
        kinds: kinds.to_vec(),
        why: None,
    })
}
