//! What four motors were sent.

use crate::flight::series::period;
use crate::flight::spans::{Span, contain};
use crate::flight::{MOTORS, Stream};
use crate::insight::criteria::identified::MOTOR_END_SHARE;
use crate::insight::diagnose::motor_loop::FOUR;
use crate::insight::prepare::rotors::columns;

/// Patterns of four motors that turn a vehicle about one axis each, in whatever order they are logged.
pub const PATTERNS: [[f64; FOUR]; 3] = [[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0], [1.0, -1.0, -1.0, 1.0]];
/// Outputs are thinned to about this rate, Hz.
const ENOUGH_HZ: f64 = 250.0;
/// Length of the stretches that a spread is taken over, s.
const STRETCH_S: f64 = 3.0;
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
    /// Squares of the outputs by pattern: a quarter of their sum, -0.5..0.5.
    pub turning: [Vec<f64>; 3],
    /// Whether no motor was at an end of its range and no turn may have been limited, there and at the samples beside.
    pub free: Vec<bool>,
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
        let turning = PATTERNS.map(|pattern| {
            let sum = |i: usize| pattern.iter().zip(&columns).map(|(sign, c)| 0.25 * sign * c[i].powi(2)).sum::<f64>();
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

    /// The stretch of time that each of these samples is in.
    pub fn stretches(&self, at: &[usize]) -> Vec<u32> {
        at.iter().map(|&i| ((self.time[i] - self.time[0]) / STRETCH_S) as u32).collect()
    }

    /// How many samples are so long.
    pub fn apart(&self, seconds: f64) -> usize {
        ((seconds / self.step).round() as usize).max(1)
    }
}
