//! Gusts: specific force that the model does not predict, with a memory of a tenth of a second or more, on both
//! horizontal axes. They have no mean, and show in the variance.

mod of_speed;
pub mod rivals;

use super::finding::{Finding, Value};
use crate::base::stats::{NORMAL_95, mean, median};
use crate::insight::criteria::chance::{
    ESTIMATOR_RATIO, GUST_BALANCED, GUST_LASTING, GUST_MEMORY_S, GUST_ONE_WAY, GUST_OWN, GUST_STRUCTURE,
};
use crate::insight::criteria::flown::GUST_ROWS;
use crate::insight::criteria::material::MATERIAL_GUST;
use crate::insight::criteria::replicated::AGREEING_STRETCHES;
use crate::insight::diagnose::prediction::channels::{FORCE, PUSH};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::prediction::record::BIN_S;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::steady_air;
use crate::insight::diagnose::structure::oscillation;
use crate::insight::estimate::robust::capped;
use crate::model::effects::{self, Card, Role};

/// Residuals are capped at so many standard deviations.
const CAP: f64 = 6.0;
/// Lags between which the memory of gusts is looked for, in bins.
const LAGS: [usize; 2] = [6, 18];
/// Parts of the flight, from one to the next of which a drag may change.
const PARTS: usize = 4;
/// Speed from which drag over speed tells how drag changes, m/s.
const TOLD_M_S: f64 = 2.0;

/// Gusts, where the forces' residual holds them; `structure_rms` of it is structure, m/s2.
pub fn find(problem: &Problem, selection: &Selection, structure_rms: f64) -> Option<Finding> {
    let card: &'static Card = effects::acting(Role::RandomForce).next()?;
    let common = Autocovariance::of(problem, selection, 1)?;
    let (sigma, tau) = (common.sigma(), common.tau());
    let swings = !oscillation::find(problem, &selection.point.residual).is_empty();
    if common.stretches() < AGREEING_STRETCHES.get()
        || swings
        || sigma < MATERIAL_GUST.get()
        || !common.is_balanced()
        || !common.lasts()
        || tau < GUST_MEMORY_S.get()
        || structure_rms > GUST_STRUCTURE.get() * sigma
        || sigma < ESTIMATOR_RATIO.get() * estimated(problem, selection)
    {
        return None;
    }
    let (near, far) = (common.near(), common.far());
    let half = NORMAL_95 * 0.5 * sigma * common.spread(0) / near;
    let relative = (common.spread(0) / near).hypot(common.spread(1) / far);
    let half_tau = NORMAL_95 * tau * tau / apart_s() * relative;
    let value = |v: f64, h: f64, unit: &str| Value { value: v, low: v - h, high: v + h, unit: unit.into() };
    let sizes = card.parameters.iter().zip([(sigma, half), (tau, half_tau)]);
    let mut found = Finding {
        channel: "specific force x",
        parameters: sizes.map(|(p, (v, h))| (p.name.to_string(), value(v, h, p.unit))).collect(),
        stretches: common.stretches(),
        impact: sigma * (2.0 * tau.min(1.0) * 1.0).sqrt(),
        ..Finding::of(card)
    };
    if steady_air::lasting(problem, selection) > GUST_ONE_WAY.get() {
        found.suspect("it pushes one way for seconds: a wind that turns, or that is not the same everywhere".into());
    }
    let [whole, beside_change] = [0, PARTS].map(|parts| Autocovariance::of(problem, selection, parts));
    let own = GUST_OWN.get() * whole?.near();
    if common.near() < own {
        found.suspect("most of it goes with the vehicle's own speed: a drag of another form leaves the same".into());
    } else if beside_change?.near() < own {
        found.suspect("most of it goes with the vehicle's own speed: a drag that changes in the flight does so".into());
    }
    Some(found)
}

/// What errors of the logged velocity look like in the forces, m/s2: how much of it the pushes show, which the air has
/// no part in, times how the predicted drag changes with it.
fn estimated(problem: &Problem, selection: &Selection) -> f64 {
    let squares: Vec<f64> = selection.point.residual[PUSH..PUSH + 2].iter().flatten().map(|r| r * r).collect();
    if squares.is_empty() {
        return 0.0;
    }
    let mut slopes = Vec::new();
    for axis in 0..2 {
        for row in &problem.rows[FORCE + axis] {
            let (f, i) = (row.flight as usize, row.sample as usize);
            let v = problem.records[f].velocity[axis][i];
            if v.abs() > TOLD_M_S {
                // Drag goes with the square: its slope is twice its ratio.
                slopes.push(2.0 * (selection.point.state[f].force[i][axis] / v).abs());
            }
        }
    }
    let slope = if slopes.is_empty() { 0.0 } else { median(&slopes) };
    slope * mean(&squares).sqrt()
}

/// Time between the two lags, s.
fn apart_s() -> f64 {
    (LAGS[1] - LAGS[0]) as f64 * BIN_S
}

/// What the horizontal residuals have in common with themselves at each of [`LAGS`].
struct Autocovariance {
    /// By axis and lag, m2/s4.
    lags: [[f64; 2]; 2],
    /// Stretches that agree on the first lag, by axis.
    agree: [f64; 2],
    /// By stretch of time and lag, of both axes.
    blocks: Vec<[f64; 2]>,
}

impl Autocovariance {
    /// Of the residuals, or of what no form of a drag explains of them that may change in so many parts of the flight.
    fn of(problem: &Problem, selection: &Selection, parts: usize) -> Option<Self> {
        let mut out = Self { lags: [[0.0; 2]; 2], agree: [0.0; 2], blocks: vec![[0.0; 2]; problem.blocks] };
        for axis in 0..2 {
            let (rows, residual) = (&problem.rows[FORCE + axis], &selection.point.residual[FORCE + axis]);
            if rows.len() < GUST_ROWS.count() {
                return None;
            }
            let mut y = capped(residual, CAP, 0.0);
            if parts > 0 {
                y = of_speed::without(problem, selection, axis, &y, parts);
            }
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
                out.lags[axis][which] = sum / n;
                blocks.iter().zip(&mut out.blocks).for_each(|(b, all)| all[which] += b / n);
                if which == 0 && sum > 0.0 {
                    out.agree[axis] = sum * sum / blocks.iter().map(|b| b * b).sum::<f64>().max(1e-300);
                }
            }
        }
        Some(out)
    }

    fn both(&self, which: usize) -> f64 {
        0.5 * (self.lags[0][which] + self.lags[1][which])
    }

    fn near(&self) -> f64 {
        self.both(0)
    }

    fn far(&self) -> f64 {
        self.both(1).max(1e-9)
    }

    /// Time in which it is forgotten, s.
    fn tau(&self) -> f64 {
        apart_s() / (self.near() / self.far()).max(1.02).ln()
    }

    /// Standard deviation, m/s2.
    fn sigma(&self) -> f64 {
        (self.near().max(0.0) * (LAGS[0] as f64 * BIN_S / self.tau()).exp()).sqrt()
    }

    /// Stretches that agree on both axes.
    fn stretches(&self) -> f64 {
        self.agree[0].min(self.agree[1])
    }

    /// The air is as restless to one side as to the other.
    fn is_balanced(&self) -> bool {
        let [x, y] = [self.lags[0][0], self.lags[1][0]];
        x.min(y) > GUST_BALANCED.get() * x.max(y)
    }

    /// The air is as restless early as late; drag that sets in is not.
    fn lasts(&self) -> bool {
        let n = self.blocks.len();
        let quarter = |q: usize| {
            let part = &self.blocks[q * n / 4..(q + 1) * n / 4];
            mean(&part.iter().map(|b| b[0]).collect::<Vec<_>>())
        };
        let quarters: Vec<f64> = (0..4).map(quarter).collect();
        let (least, most) = quarters.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), q| (l.min(*q), m.max(*q)));
        least > GUST_LASTING.get() * most
    }

    /// Standard error of the mean of both axes at a lag.
    fn spread(&self, which: usize) -> f64 {
        let n = self.blocks.len() as f64;
        let m = mean(&self.blocks.iter().map(|b| b[which]).collect::<Vec<_>>());
        (self.blocks.iter().map(|b| (b[which] - m).powi(2)).sum::<f64>() * n / (n - 1.0)).sqrt() * 0.5
    }
}
