//! What four motors were sent, and how it turns the vehicle.

use crate::flight::series::{interpolated, period};
use crate::flight::spans::{Span, contain};
use crate::flight::{Log, MOTORS, Stream};
use crate::insight::criteria::identified::MOTOR_END_SHARE;
use crate::insight::diagnose::motors::FOUR;
use crate::insight::estimate::gram::dot;
use crate::insight::prepare::rotors::columns;

/// Patterns of four motors that turn a vehicle about one axis each, in whatever order they are logged.
const PATTERNS: [[f64; FOUR]; 3] = [[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0], [1.0, -1.0, -1.0, 1.0]];
/// Outputs are thinned to about this rate, Hz.
const ENOUGH_HZ: f64 = 250.0;
/// Rates are compared with those so long before, s.
const TURN_S: f64 = 0.04;
/// Lags of motors, s, the first and how many times as long each is as the one before.
const LAGS: (f64, f64, i32) = (0.008, 1.144, 16);
/// Share of the largest turn that was asked for beyond which it may have been limited.
const LIMITED: f64 = 0.97;

/// What the motors were sent, thinned.
pub struct Outputs {
    /// s.
    pub time: Vec<f64>,
    /// Usual time between two, s.
    step: f64,
    /// Whether all motors are known there, in usable flight.
    pub usable: Vec<bool>,
    /// Squares as shares of the largest output's, by pattern: a quarter of their sum, -0.5..0.5.
    pub turning: [Vec<f64>; 3],
    /// Whether no motor was at an end of its range and no turn may have been limited, there and at the samples beside.
    pub free: Vec<bool>,
}

/// How the vehicle turns about an axis.
pub struct TurningPlant {
    /// Of [`PATTERNS`], the one that turns it.
    pub pattern: usize,
    /// Lag of the motors, s.
    pub lag_s: f64,
    /// Angular acceleration by a pattern's output of 1, rad/s2, with its sign.
    pub authority: f64,
    /// Share of the squares of the turns that is explained, 0..1.
    pub turned: f64,
}

impl Outputs {
    /// Of the `usable` times; none where there are not four motors that come often enough.
    pub fn new(motors: &Stream<MOTORS>, usable: &[Span]) -> Option<Self> {
        let every = (1.0 / (period(&motors.time_s) * ENOUGH_HZ) * 1.05).floor().max(1.0) as usize;
        let columns = columns(motors).filter(|columns| columns.len() == FOUR)?;
        let columns: Vec<Vec<f64>> = columns.iter().map(|c| c.iter().copied().step_by(every).collect()).collect();
        let time: Vec<f64> = motors.time_s.iter().copied().step_by(every).collect();
        let known = |i: usize| columns.iter().all(|c| c[i].is_finite());
        let usable: Vec<bool> = (0..time.len()).map(|i| known(i) && contain(usable, time[i])).collect();
        let all = || columns.iter().flatten().copied().filter(|u| u.is_finite());
        let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)));
        let near = MOTOR_END_SHARE.get() * (high - low);
        let share = |c: &Vec<f64>, i: usize| (c[i] / high).powi(2);
        let turning = PATTERNS.map(|pattern| {
            let sum = |i| pattern.iter().zip(&columns).map(|(sign, c)| 0.25 * sign * share(c, i)).sum::<f64>();
            (0..time.len()).map(|i| if known(i) { sum(i) } else { 0.0 }).collect::<Vec<f64>>()
        });
        let most = [0, 1, 2].map(|h: usize| turning[h].iter().fold(0.0, |most: f64, a| most.max(a.abs())));
        let ends = |i: usize| columns.iter().any(|c| c[i] < low + near || c[i] > high - near);
        let limited = |i: usize| (0..3).any(|h| turning[h][i].abs() > LIMITED * most[h]);
        let free: Vec<bool> = (0..time.len()).map(|i| known(i) && !ends(i) && !limited(i)).collect();
        let free = (0..free.len()).map(|i| i > 0 && free[i - 1..free.len().min(i + 2)].iter().all(|f| *f)).collect();
        Some(Self { step: period(&time), time, usable, turning, free })
    }

    /// The outputs of a pattern behind a lag, s, and their integral by each sample, s.
    pub fn lagged(&self, pattern: usize, lag_s: f64) -> [Vec<f64>; 2] {
        let (mut now, mut sum) = (0.0, 0.0);
        let mut out = [Vec::with_capacity(self.time.len()), Vec::with_capacity(self.time.len())];
        for (i, output) in self.turning[pattern].iter().enumerate() {
            let dt = if i > 0 { self.time[i] - self.time[i - 1] } else { 0.0 };
            let before = now;
            now += (output - now) * (1.0 - (-dt / lag_s).exp());
            sum += 0.5 * (before + now) * dt;
            out[0].push(now);
            out[1].push(sum);
        }
        out
    }

    /// Samples that are `apart` from one before, both `fit`; the earlier ones.
    pub fn pairs(&self, apart: usize, fit: impl Fn(usize) -> bool) -> Vec<usize> {
        let most = 2.0 * apart as f64 * self.step;
        let near = |i: &usize| self.time[i + apart] - self.time[*i] < most;
        (0..self.time.len().saturating_sub(apart)).filter(|&i| fit(i) && fit(i + apart)).filter(near).collect()
    }

    /// How many samples are so long.
    pub fn apart(&self, seconds: f64) -> usize {
        ((seconds / self.step).round() as usize).max(1)
    }

    /// The pattern and the lag that explain the rate about axis `k` best.
    pub fn plant(&self, log: &Log, k: usize) -> Option<TurningPlant> {
        let reach = 3.0 * period(&log.imu.time_s);
        let rate = interpolated(&log.imu.time_s, &log.imu.column(k), &self.time, reach);
        let apart = self.apart(TURN_S);
        let at = self.pairs(apart, |i| self.usable[i] && rate[i].is_finite());
        let turned = |x: &[f64]| at.iter().map(|&i| x[i + apart] - x[i]).collect::<Vec<f64>>();
        let measured = turned(&rate);
        let plants = (0..3 * LAGS.2).map(|i| {
            let (pattern, lag_s) = ((i % 3) as usize, LAGS.0 * LAGS.1.powi(i / 3));
            let x = turned(&self.lagged(pattern, lag_s)[1]);
            let (along, own) = (dot(&x, &measured), dot(&x, &x).max(1e-300));
            TurningPlant {
                pattern,
                lag_s,
                authority: along / own,
                turned: along * along / own / dot(&measured, &measured),
            }
        });
        plants.filter(|p| p.turned.is_finite()).max_by(|a, b| a.turned.total_cmp(&b.turned))
    }
}
