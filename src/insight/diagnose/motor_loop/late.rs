//! Where a delay sits: before what the motors are sent, or behind it. Commands that come late reach the motors late; a
//! stamp that is late leaves the motors prompt, and lets the vehicle turn and climb late by what they were sent.

use super::outputs::Outputs;
use super::plant::{MeasuredTurns, plants};
use crate::base::stats::{mean, mean_half_width};
use crate::flight::Log;
use crate::flight::series::{held, period};
use crate::flight::spans::{Span, contain};
use crate::insight::criteria::rival::{BEFORE_SHARE, BEHIND_SHARE};
use crate::insight::estimate::gram::dot;
use crate::insight::prepare::rotors::{columns, mixing};

/// Outputs are compared with those so long before, s.
const ANSWER_S: f64 = 0.03;
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
    // Often enough, and of two at least.
    columns(&log.motors)?;
    let (time, sent) = (&log.motors.time_s, log.motors.means());
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
    let lags: Vec<f64> = (0..LAGS.2).map(|i| LAGS.0 * LAGS.1.powi(i)).collect();
    let about = |k: usize| {
        let turned = |delay_s: f64| {
            let turns = MeasuredTurns::new(&outputs, log, k, delay_s);
            let turned = lags.iter().map(|&lag_s| turns.plant(plants[k].pattern, lag_s, false).turned);
            (turned.fold(0.0, f64::max), delay_s)
        };
        let best = steps(OF_TURNS_S).map(turned).max_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|(turned, _)| *turned > LIKE * LIKE).map(|(_, delay_s)| delay_s)
    };
    Some(about(0)?.min(about(1)?))
}

fn steps([first, last, step]: [f64; 3]) -> impl Iterator<Item = f64> {
    (0..=((last - first) / step).round() as usize).map(move |k| first + step * k as f64)
}

/// Cosine of the angle between two columns.
fn likeness(x: &[f64], y: &[f64]) -> f64 {
    dot(x, y) / (dot(x, x) * dot(y, y)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::motors::row;
    use crate::insight::diagnose::motor_loop::outputs::PATTERNS;

    /// A minute in which throttle and turns step every 0.2 s: the motors have them late by `before`, the gyro what they
    /// do, behind a lag of 20 ms, by `behind`, s.
    fn flown(before: f64, behind: f64) -> Log {
        const DT: f64 = 0.002;
        let mut log = Log::default();
        let mut turning = [0.0; 3];
        let mut rates = [0.0; 3];
        let step = |t: f64, k: usize| ((t / 0.2).floor() * (7.3 + 3.1 * k as f64)).sin();
        for i in 0..30_000 {
            let t = i as f64 * DT;
            let (throttle, late) = (0.5 + 0.1 * step(t, 3), t - before);
            log.setpoint.push(t, [0.0, 0.0, 0.0, throttle]);
            let wanted: [f64; 3] = std::array::from_fn(|k| 0.04 * step(late + 0.01 * k as f64, k) - 0.01 * rates[k]);
            let share = |m: usize| (0..3).map(|k| PATTERNS[k][m] * wanted[k]).sum::<f64>();
            let outputs: Vec<f64> = (0..4).map(|m| ((0.5 + 0.1 * step(late, 3)).powi(2) + share(m)).sqrt()).collect();
            log.motors.push(t, row(&outputs));
            for k in 0..3 {
                turning[k] += (wanted[k] - turning[k]) * (1.0 - (-DT / 0.02f64).exp());
                rates[k] += 200.0 * turning[k] * DT;
            }
            log.imu.push(t + DT + behind, [rates[0], rates[1], rates[2], 0.0, 0.0, 9.8]);
        }
        log
    }

    #[test]
    fn a_delay_is_measured_where_it_sits() {
        let of = |before: f64, behind: f64| MotorsLate::new(&flown(before, behind), &[[1.0, 59.0]]).expect("it tells");
        let (commands, stamp) = (of(0.01, 0.0), of(0.0, 0.01));
        // Within a period of the log: finer than that a step has no time.
        assert!((commands.outputs_s - 0.01).abs() < 2e-3 && commands.turns_s < 3e-3, "{commands:?}");
        assert!(stamp.outputs_s.abs() < 2e-3 && (stamp.turns_s - 0.01).abs() < 3e-3, "{stamp:?}");
        assert!(commands.is_before(0.01) && stamp.is_behind(0.01), "{commands:?} {stamp:?}");
        let silent = Log { motors: Default::default(), ..flown(0.0, 0.01) };
        assert_eq!(MotorsLate::new(&silent, &[[1.0, 59.0]]), None);
    }

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
