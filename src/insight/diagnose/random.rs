//! Effects of chance: they have no mean, or one that looks like another effect's, and show in the variance.

use super::finding::{Finding, Value};
use super::predict::{FORCE, RATE};
use super::problem::Problem;
use super::select::Selection;
use crate::base::stats::{NORMAL_95, mean, robust_sd};
use crate::insight::estimate::robust::capped;
use crate::model::dynamics::response::alpha;
use crate::model::effects::{self, Card, Role};

/// Stretches of flight that have to agree.
const REPLICATED: f64 = 15.0;
/// Smallest gust that is worth a word, m/s2.
const LEAST_GUST: f64 = 0.08;
/// Residuals are capped at so many standard deviations.
const CAP: f64 = 6.0;
/// Lags between which the memory of gusts is looked for, in bins.
const LAGS: [usize; 2] = [6, 18];

/// What large stick movements say about lost commands: of each, how much of the error is there that its loss would leave.
#[derive(Clone, Copy, Debug)]
pub struct Lost {
    /// Share of the commands that is lost, with its 95 % interval.
    pub share: f64,
    pub interval: [f64; 2],
    /// Movements whose whole error is there, and those with about half of it: a loss is all or nothing.
    pub whole: usize,
    pub half: usize,
    /// Movements that were answered before they were due: a loss never is, a link whose delay varies is as often early as late.
    pub early: usize,
}

/// A movement is looked at where its loss would show beyond so many standard deviations of the noise.
const CLEAR: f64 = 12.0;
/// The same for an answer that comes early, and the share of a movement that it has to be.
const EARLY_CLEAR: f64 = 4.0;
const EARLY: f64 = 0.4;

/// Holds the rate residuals against the error that each lost command would leave: the change of the command, for one period, behind the lag.
pub fn lost_commands(problem: &Problem, selection: &Selection) -> Lost {
    let x = &selection.point.x;
    let p = problem.model.parameters(x);
    let late = crate::model::dynamics::extended::command_delays(&p);
    let (mut whole, mut half, mut kept, mut early) = (0usize, 0usize, 0usize, 0usize);
    for axis in 0..3 {
        let (rows, residual) = (&problem.rows[RATE + axis], &selection.point.residual[RATE + axis]);
        let noise = robust_sd(residual);
        let tau = x[super::numbers::TAU.start + axis];
        for (f, record) in problem.records.iter().enumerate() {
            let mut by_bin = vec![f64::NAN; record.bins.len()];
            let own = rows.iter().zip(residual).filter(|(row, _)| row.flight as usize == f);
            own.for_each(|(row, r)| by_bin[row.index as usize] = *r);
            let middles: Vec<f64> =
                record.bins.iter().map(|b| 0.5 * (record.time[b[0]] + record.time[b[1] - 1])).collect();
            for three in record.sent.windows(3) {
                let pair = &three[1..];
                let change = (pair[1].1[axis] - pair[0].1[axis]) * p.compact.max_rate[axis];
                // What the loss of the command before would leave reaches into this one.
                let earlier = (three[1].1[axis] - three[0].1[axis]) * p.compact.max_rate[axis];
                if change.abs() < CLEAR * noise || earlier.abs() > 0.25 * change.abs() {
                    continue;
                }
                let (begin, held) = (pair[1].0 + late[axis], pair[1].0 - pair[0].0);
                let rise = |t: f64| if t > 0.0 { alpha(tau, t) } else { 0.0 };
                let first = middles.partition_point(|t| *t < begin);
                let (mut along, mut square) = (0.0, 0.0);
                for bin in first..middles.len().min(first + 3) {
                    let since = middles[bin] - begin;
                    let shape = change * (rise(since) - rise(since - held));
                    along -= shape * by_bin[bin];
                    square += shape * shape;
                }
                if square < (CLEAR * noise).powi(2) || !along.is_finite() {
                    continue;
                }
                let due = middles.partition_point(|t| *t < begin - held);
                let (mut ahead, mut most) = (0.0, 0.0);
                for bin in due..first {
                    let shape = change * rise(middles[bin] - (begin - held));
                    ahead += shape * by_bin[bin];
                    most += shape * shape;
                }
                early += usize::from(most > (EARLY_CLEAR * noise).powi(2) && ahead > EARLY * most);
                match along / square {
                    a if (0.7..1.4).contains(&a) => whole += 1,
                    a if (0.3..0.7).contains(&a) => half += 1,
                    _ => kept += 1,
                }
            }
        }
    }
    let n = (whole + half + kept).max(1) as f64;
    let share = (whole + half) as f64 / n;
    let spread = NORMAL_95 * (share * (1.0 - share) / n).sqrt();
    Lost { share, interval: [share - spread, share + spread], whole, half, early }
}

/// Whether commands get lost, by a share that matters.
pub fn are_lost(lost: &Lost, card: &Card) -> bool {
    lost.whole >= 12
        && lost.whole > 2 * lost.half
        && lost.whole > 2 * lost.early
        && lost.share > 0.5 * card.parameters[0].typical[0]
}

/// Gusts: specific force that the model does not predict, with a memory of a tenth of a second or more, on both horizontal axes.
pub fn gusts(problem: &Problem, selection: &Selection, structure_rms: f64) -> Option<Finding> {
    let card: &'static Card = effects::acting(Role::RandomForce).next()?;
    let mut lags = [[0.0; 2]; 2];
    let mut agree = [0.0; 2];
    let mut blocks_all: Vec<[f64; 2]> = vec![[0.0; 2]; problem.blocks];
    for axis in 0..2 {
        let (rows, residual) = (&problem.rows[FORCE + axis], &selection.point.residual[FORCE + axis]);
        if rows.len() < 1000 {
            return None;
        }
        let y = capped(residual, CAP, 0.0);
        for (which, lag) in LAGS.into_iter().enumerate() {
            let mut blocks = vec![0.0; problem.blocks];
            let mut n = 0.0;
            for i in lag..rows.len() {
                if rows[i].flight == rows[i - lag].flight && rows[i].index == rows[i - lag].index + lag as u32 {
                    blocks[rows[i].block as usize] += y[i] * y[i - lag];
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
    // The air is as restless early as late; drag that sets in is not.
    let quarter = |q: usize| {
        let part = &blocks_all[q * problem.blocks / 4..(q + 1) * problem.blocks / 4];
        mean(&part.iter().map(|b| b[0]).collect::<Vec<_>>())
    };
    let quarters: Vec<f64> = (0..4).map(quarter).collect();
    let (least, most) = quarters.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), q| (l.min(*q), m.max(*q)));
    let lasting = least > 0.1 * most;
    let balanced = lags[0][0].min(lags[1][0]) > 0.15 * lags[0][0].max(lags[1][0]);
    let swings = !super::oscillation::find(problem, &selection.point.residual).is_empty();
    if stretches < REPLICATED
        || swings
        || sigma < LEAST_GUST
        || !balanced
        || !lasting
        || tau < 0.05
        || structure_rms > 0.7 * sigma
    {
        return None;
    }
    let n = problem.blocks as f64;
    let spread = |which: usize| {
        let m = mean(&blocks_all.iter().map(|b| b[which]).collect::<Vec<_>>());
        (blocks_all.iter().map(|b| (b[which] - m).powi(2)).sum::<f64>() * n / (n - 1.0)).sqrt() * 0.5
    };
    let half = NORMAL_95 * 0.5 * sigma * spread(0) / near;
    let half_tau = NORMAL_95 * tau * tau / apart * (spread(0) / near).hypot(spread(1) / far);
    let value = |v: f64, h: f64, unit: &str| Value { value: v, low: v - h, high: v + h, unit: unit.into() };
    let sizes = card.parameters.iter().zip([(sigma, half), (tau, half_tau)]);
    Some(Finding {
        channel: "specific force x",
        parameters: sizes.map(|(p, (v, h))| (p.name.to_string(), value(v, h, p.unit))).collect(),
        stretches,
        impact: sigma * (2.0 * tau.min(1.0) * 1.0).sqrt(),
        ..Finding::of(card)
    })
}
