//! How what the motors are sent turns the vehicle about an axis.

use super::outputs::{Outputs, PATTERNS};
use crate::flight::Log;
use crate::flight::series::{interpolated, period};
use crate::insight::estimate::gram::{Grams, dot};
use crate::insight::estimate::jackknife::jackknife;

/// Rates are compared with those so long before, s.
const TURN_S: f64 = 0.04;
/// Lags of motors, s, the first and how many times as long each is as the one before.
const LAGS: (f64, f64, i32) = (0.008, 1.144, 16);

/// How the vehicle turns about an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningPlant {
    /// Of [`PATTERNS`], the one that turns it.
    pub pattern: usize,
    /// Lag of the motors, s.
    pub lag_s: f64,
    /// Angular acceleration by a pattern's output of 1, rad/s2, with its sign, and its standard deviation.
    pub authority: f64,
    pub sd: f64,
    /// Share of the squares of the turns that is explained, 0..1.
    pub turned: f64,
}

/// About roll, pitch and yaw. What turns about yaw is led by the rotors' own inertia: beside the outputs their change
/// counts, behind the lag of the other two axes.
pub fn plants(outputs: &Outputs, log: &Log) -> Option<[TurningPlant; 3]> {
    let [roll, pitch, yaw] = [0, 1, 2].map(|k| MeasuredTurns::new(outputs, log, k, 0.0));
    let lags: Vec<f64> = (0..LAGS.2).map(|i| LAGS.0 * LAGS.1.powi(i)).collect();
    let (roll, pitch) = (roll.best(&lags, false)?, pitch.best(&lags, false)?);
    let yaw = yaw.best(&[(roll.lag_s * pitch.lag_s).sqrt()], true)?;
    Some([roll, pitch, yaw])
}

/// Measured turns about an axis.
pub struct MeasuredTurns<'a> {
    outputs: &'a Outputs,
    /// Earlier samples of the pairs that are compared, and how far apart the two are.
    at: Vec<usize>,
    apart: usize,
    /// rad/s.
    measured: Vec<f64>,
}

impl<'a> MeasuredTurns<'a> {
    /// About axis `k`, of a gyro that is late by so much, s.
    pub fn new(outputs: &'a Outputs, log: &Log, k: usize, late_s: f64) -> Self {
        let reach = 3.0 * period(&log.imu.time_s);
        let then: Vec<f64> = outputs.time.iter().map(|t| t + late_s).collect();
        let rate = interpolated(&log.imu.time_s, &log.imu.column(k), &then, reach);
        let apart = outputs.apart(TURN_S);
        let at = outputs.pairs(apart, |i| outputs.usable[i] && rate[i].is_finite());
        let mut turns = Self { outputs, at, apart, measured: Vec::new() };
        turns.measured = turns.moved(&rate);
        turns
    }

    fn moved(&self, x: &[f64]) -> Vec<f64> {
        self.at.iter().map(|&i| x[i + self.apart] - x[i]).collect()
    }

    /// The pattern and the lag, of these, that explain it best; beside the change of the outputs where that leads.
    fn best(&self, lags_s: &[f64], led: bool) -> Option<TurningPlant> {
        let patterns = |&lag_s: &f64| (0..PATTERNS.len()).map(move |pattern| self.plant(pattern, lag_s, led));
        let told = lags_s.iter().flat_map(patterns).filter(|p| p.turned.is_finite());
        let plant = told.max_by(|a, b| a.turned.total_cmp(&b.turned))?;
        Some(TurningPlant { sd: self.sd(&plant, led)?, ..plant })
    }

    /// Without the spread of its authority.
    pub fn plant(&self, pattern: usize, lag_s: f64, led: bool) -> TurningPlant {
        let [own, mut left] = self.own(pattern, lag_s, led);
        let authority = take_off(&mut left, &own);
        let turned = 1.0 - dot(&left, &left) / dot(&self.measured, &self.measured);
        TurningPlant { pattern, lag_s, authority, sd: f64::NAN, turned }
    }

    /// Standard deviation of its authority, by the stretches of time.
    fn sd(&self, plant: &TurningPlant, led: bool) -> Option<f64> {
        let [own, mut left] = self.own(plant.pattern, plant.lag_s, led);
        take_off(&mut left, &own);
        let stretch = self.outputs.stretches(&self.at);
        let blocks = *stretch.last()? as usize + 1;
        let grams = Grams::new(&[&vec![own], &vec![left]], &[stretch], blocks);
        Some(jackknife(&grams, &[0], 1, &[0.0], 1)?.0[(0, 0)].sqrt())
    }

    /// What a pattern behind a lag, s, turns by, and the turns; both without what they have of its change where it
    /// leads.
    fn own(&self, pattern: usize, lag_s: f64, led: bool) -> [Vec<f64>; 2] {
        let [change, mut own] = self.outputs.lagged(pattern, lag_s).map(|x| self.moved(&x));
        let mut turns = self.measured.clone();
        if led {
            take_off(&mut own, &change);
            take_off(&mut turns, &change);
        }
        [own, turns]
    }
}

/// Takes off `x` what it has of `y`: so many times.
fn take_off(x: &mut [f64], y: &[f64]) -> f64 {
    let times = dot(x, y) / dot(y, y).max(1e-300);
    x.iter_mut().zip(y).for_each(|(x, y)| *x -= times * y);
    times
}
