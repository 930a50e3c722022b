//! Where a delay sits: before what the motors are sent, or behind it. Commands that come late reach the motors late; a
//! stamp that is late leaves the motors prompt, and lets the vehicle turn and climb late by what they were sent.

use super::outputs::Outputs;
use super::plant::plants;
use crate::base::stats::{mean, mean_half_width};
use crate::flight::Log;
use crate::flight::series::{held, interpolated, period};
use crate::flight::spans::{Span, contain};
use crate::insight::criteria::rival::{BEFORE_SHARE, BEHIND_SHARE};
use crate::insight::estimate::gram::dot;
use crate::insight::prepare::rotors::{columns, mixing};

/// Outputs are compared with those so long before, and rates with theirs, s.
const ANSWER_S: f64 = 0.03;
const TURN_S: f64 = 0.04;
/// Delays that are tried, s: the first, the last, and the step between two.
const OF_OUTPUTS_S: [f64; 3] = [-0.004, 0.04, 0.001];
const OF_TURNS_S: [f64; 3] = [0.0, 0.02, 0.002];
/// Lags of motors, s, the first and how many times as long each is as the one before.
const LAGS: (f64, f64, i32) = (0.006, 1.25, 11);
/// Parts of a flight that each tell a delay, and the least likeness of what does.
const PARTS: usize = 12;
const LIKE: f64 = 0.5;

/// How late the motors' outputs are, and what they do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorsLate {
    /// By how much the mean of the outputs follows the throttle, and half of its 95 % interval, s.
    pub outputs_s: f64,
    pub half: f64,
    /// By how much roll and pitch at least follow the outputs, beyond a lag, s.
    pub turns_s: f64,
}

impl MotorsLate {
    /// Of a flight; none where its outputs do not tell.
    pub fn new(log: &Log, usable: &[Span]) -> Option<Self> {
        let (outputs_s, half) = outputs_late(log, usable)?;
        Some(Self { outputs_s, half, turns_s: turns_late(log, usable)? })
    }

    /// Whether a delay of thrust and rates, s, is one that commands have before they reach the motors.
    pub fn is_before(&self, delay_s: f64) -> bool {
        self.outputs_s - self.half > BEFORE_SHARE.get() * delay_s
    }

    /// Whether the motors are sent their thrust without it.
    pub fn is_prompt(&self, delay_s: f64) -> bool {
        self.outputs_s + self.half < BEFORE_SHARE.get() * delay_s
    }

    /// Whether all of it comes behind the outputs, in turns as in thrust.
    pub fn is_behind(&self, delay_s: f64) -> bool {
        self.is_prompt(delay_s) && self.turns_s > BEHIND_SHARE.get() * delay_s
    }
}

/// By how much the mean of what the motors are sent follows the throttle, and half of its 95 % interval, s.
fn outputs_late(log: &Log, usable: &[Span]) -> Option<(f64, f64)> {
    let (columns, time) = (columns(&log.motors)?, &log.motors.time_s);
    let sent: Vec<f64> = (0..time.len()).map(|i| mean(&columns.iter().map(|c| c[i]).collect::<Vec<_>>())).collect();
    let (mixing, throttle) = (mixing(log), log.setpoint.column(3));
    let fit = |i: usize| contain(usable, time[i]) && !contain(&mixing, time[i]) && sent[i].is_finite();
    let apart = ((ANSWER_S / period(time)).round() as usize).max(1);
    let near = |i: usize| time[i + apart] - time[i] < 2.0 * ANSWER_S;
    let at = (0..time.len().saturating_sub(apart)).filter(|&i| fit(i) && fit(i + apart) && near(i));
    let at: Vec<usize> = at.collect();
    let moved: Vec<f64> = at.iter().map(|&i| sent[i + apart] - sent[i]).collect();
    let size = at.len() / PARTS;
    let mut told = [(LIKE, f64::NAN); PARTS];
    for delay_s in steps(OF_OUTPUTS_S) {
        let late: Vec<f64> = time.iter().map(|t| t - delay_s).collect();
        let wanted = held(&log.setpoint.time_s, &throttle, &late);
        let wanted: Vec<f64> = at.iter().map(|&i| wanted[i + apart] - wanted[i]).collect();
        for (part, best) in told.iter_mut().enumerate() {
            let rows = part * size..(part + 1) * size;
            let like = likeness(&wanted[rows.clone()], &moved[rows]);
            if like > best.0 {
                *best = (like, delay_s);
            }
        }
    }
    let delays: Vec<f64> = told.iter().map(|(_, delay_s)| *delay_s).filter(|d| d.is_finite()).collect();
    // Finer than its grid nothing is known.
    let half = mean_half_width(&delays, 0.95)?.max(0.5 * OF_OUTPUTS_S[2]);
    (2 * delays.len() > PARTS).then_some((mean(&delays), half))
}

/// By how much turns about roll and pitch follow what the motors are sent, beyond a lag, s: the smaller of the two.
fn turns_late(log: &Log, usable: &[Span]) -> Option<f64> {
    let outputs = Outputs::new(&log.motors, usable)?;
    let plants = plants(&outputs, log)?;
    let (reach, apart) = (3.0 * period(&log.imu.time_s), outputs.apart(TURN_S));
    let lags = || (0..LAGS.2).map(|i| LAGS.0 * LAGS.1.powi(i));
    let about = |k: usize| {
        let gyro = log.imu.column(k);
        let sums: Vec<Vec<f64>> = lags().map(|lag_s| outputs.lagged(plants[k].pattern, lag_s)[1].clone()).collect();
        let at_delay = |delay_s: f64| {
            let then: Vec<f64> = outputs.time.iter().map(|t| t + delay_s).collect();
            let rate = interpolated(&log.imu.time_s, &gyro, &then, reach);
            let at = outputs.pairs(apart, |i| outputs.usable[i] && rate[i].is_finite());
            let moved = |x: &[f64]| at.iter().map(|&i| x[i + apart] - x[i]).collect::<Vec<f64>>();
            let turned = moved(&rate);
            let likeness = sums.iter().map(|sum| likeness(&moved(sum), &turned).abs());
            (likeness.fold(0.0, f64::max), delay_s)
        };
        let best = steps(OF_TURNS_S).map(at_delay).max_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|(like, _)| *like > LIKE).map(|(_, delay_s)| delay_s)
    };
    Some(about(0)?.min(about(1)?))
}

fn steps([first, last, step]: [f64; 3]) -> impl Iterator<Item = f64> {
    (0..=((last - first) / step).round() as usize).map(move |k| first + step * k as f64)
}

fn likeness(x: &[f64], y: &[f64]) -> f64 {
    dot(x, y) / (dot(x, x) * dot(y, y)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_delay_is_before_the_outputs_or_behind_them_or_nobody_knows() {
        let of = |outputs_s: f64, turns_s: f64| MotorsLate { outputs_s, half: 5e-4, turns_s };
        let says = |late: MotorsLate| (late.is_before(0.008), late.is_behind(0.008));
        assert_eq!(says(of(0.008, 0.002)), (true, false));
        assert_eq!(says(of(0.0, 0.01)), (false, true));
        assert_eq!(says(of(0.0, 0.002)), (false, false), "thrust alone is late");
        assert_eq!(says(MotorsLate { half: 0.02, ..of(0.004, 0.01) }), (false, false), "not sure");
    }
}
