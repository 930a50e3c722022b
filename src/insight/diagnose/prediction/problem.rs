//! All flights as rows of residuals by channel, and their derivatives by any number of the model.

use super::channels::CHANNELS;
use super::contrast::Contrast;
use super::measured::measured;
use super::model::Model;
use super::predict::Predicted;
use super::record::FlightRecord;
use crate::base::stats::mean;
use crate::insight::diagnose::motor_loop::MotorsLate;
use crate::insight::estimate::gram::Stretch;
use rayon::prelude::*;
use std::borrow::Cow;
use std::sync::Arc;

/// One row of a channel.
#[derive(Clone, Copy, Debug)]
pub struct ResidualRow {
    pub flight: u32,
    /// Index into the channel of its flight.
    pub index: u32,
    /// Stretch of time, counted over all flights.
    pub block: u32,
    /// The sample of the IMU that it begins with.
    pub sample: u32,
    /// Whether the row before is its neighbour in time.
    pub follows: bool,
}

impl Stretch for ResidualRow {
    fn stretch(&self) -> u32 {
        self.block
    }
}

/// Values by channel; empty where there is nothing.
pub type ChannelValues = [Vec<f64>; CHANNELS];

/// Flights and the model they are held against.
pub struct Problem {
    pub model: Model,
    pub records: Vec<FlightRecord>,
    pub rows: [Vec<ResidualRow>; CHANNELS],
    pub measured: ChannelValues,
    pub blocks: usize,
    /// Where later flights may differ from the others.
    pub contrast: Option<Contrast>,
    /// How late the motors' outputs are, and what they do, flight by flight; nothing where that is not known.
    pub late: Vec<MotorsLate>,
}

/// A prediction of every flight.
pub type Predictions = Vec<Predicted>;

impl Problem {
    pub fn new(model: Model, records: Vec<FlightRecord>) -> Self {
        let rows = Default::default();
        let (seen, late) = (Default::default(), Vec::new());
        let mut out = Self { model, records, rows, measured: seen, blocks: 0, contrast: None, late };
        let start = out.predict(&out.model.base);
        let gravity = out.model.vehicle().gravity_m_s2;
        out.blocks = out.records.iter().filter_map(|r| r.block.last()).map(|b| *b as usize + 1).max().unwrap_or(0);
        for (f, record) in out.records.iter().enumerate() {
            let seen = measured(record, gravity);
            for c in 0..CHANNELS {
                let mut before = usize::MAX;
                for (i, predicted) in start[f].channels[c].iter().enumerate() {
                    if !(predicted.is_finite() && seen[c][i].is_finite()) {
                        continue;
                    }
                    let [from, to] = record.place(c, i);
                    let follows = before != usize::MAX && before + 1 == i && record.adjoins(c, i);
                    before = i;
                    let block = record.block[(from + to) / 2];
                    out.rows[c].push(ResidualRow {
                        flight: f as u32,
                        index: i as u32,
                        block,
                        sample: from as u32,
                        follows,
                    });
                    out.measured[c].push(seen[c][i]);
                }
            }
        }
        out
    }

    /// By how much the odometry's clocks were moved to the gyro's, on average, s: positive where its turns came first.
    pub fn moved(&self) -> f64 {
        mean(&self.records.iter().map(|r| r.moved).collect::<Vec<_>>())
    }

    /// Whether every flight says of a delay, s, that it comes behind what the motors are sent.
    pub fn is_behind_motors(&self, delay_s: f64) -> bool {
        !self.late.is_empty() && self.late.iter().all(|late| late.is_behind(delay_s))
    }

    /// Where each flight begins on a clock that runs through all of them, s.
    pub fn clocks(&self) -> Vec<f64> {
        let length = |r: &FlightRecord| r.time.last().map_or(0.0, |end| end - r.time[0]);
        let after = |clock: &mut f64, r: &FlightRecord| Some(std::mem::replace(clock, *clock + length(r)));
        self.records.iter().scan(0.0, after).collect()
    }

    /// Of each set of flights, which stretches of time are not of it; one set where there is no contrast.
    pub fn sets(&self) -> Vec<Vec<bool>> {
        let Some(contrast) = &self.contrast else { return vec![vec![false; self.blocks]] };
        let mut later = vec![false; self.blocks];
        for (record, is_later) in self.records.iter().zip(&contrast.later) {
            record.block.iter().for_each(|b| later[*b as usize] = *is_later);
        }
        let earlier = later.iter().map(|l| !l).collect();
        vec![later, earlier]
    }

    /// The numbers of flight `f` at `x`.
    pub fn numbers<'a>(&self, f: usize, x: &'a [f64]) -> Cow<'a, [f64]> {
        self.contrast.as_ref().map_or(x.into(), |contrast| contrast.numbers(&self.model, f, x))
    }

    /// Predicts every flight at `x`.
    pub fn predict(&self, x: &[f64]) -> Predictions {
        let one = |(f, record)| Predicted::new(&self.model, record, f, &self.numbers(f, x));
        self.records.par_iter().enumerate().map(one).collect()
    }

    /// Predicts at `x`, which differs from that of `state` in the numbers `which`.
    pub fn change(&self, state: &Predictions, which: &[usize], x: &[f64]) -> Predictions {
        let one = |(f, record): (usize, &FlightRecord)| {
            let x = self.numbers(f, x);
            let reaches = |k: &usize| self.contrast.as_ref().is_none_or(|contrast| contrast.reaches(f, *k));
            let which: Vec<usize> = which.iter().copied().filter(reaches).collect();
            state[f].changed(self.model.dirty(&which, &x), &self.model, record, f, &x)
        };
        self.records.par_iter().enumerate().map(one).collect()
    }

    /// A prediction's rows.
    pub fn pick(&self, state: &Predictions) -> ChannelValues {
        std::array::from_fn(|c| {
            self.rows[c].iter().map(|row| state[row.flight as usize].channels[c][row.index as usize]).collect()
        })
    }

    /// Measured less predicted.
    pub fn residuals(&self, state: &Predictions) -> ChannelValues {
        let predicted = self.pick(state);
        std::array::from_fn(|c| self.measured[c].iter().zip(&predicted[c]).map(|(m, p)| m - p).collect())
    }

    /// Change of the prediction per unit of number `k` at `x`, whose prediction is `state`.
    pub fn slope(&self, state: &Predictions, x: &[f64], k: usize) -> ChannelValues {
        let number = &self.model.numbers[k];
        let step = if x[k] + number.step <= number.high { number.step } else { -number.step };
        self.secant(state, x, &[(k, x[k] + step)], 1.0 / step)
    }

    /// `scale` times the change of the prediction when numbers take other values. A channel that does not change is
    /// empty.
    pub fn secant(&self, state: &Predictions, x: &[f64], to: &[(usize, f64)], scale: f64) -> ChannelValues {
        let mut moved = x.to_vec();
        to.iter().for_each(|&(k, value)| moved[k] = value);
        let which: Vec<usize> = to.iter().map(|&(k, _)| k).collect();
        let changed = self.change(state, &which, &moved);
        std::array::from_fn(|c| {
            let same = |f: usize| Arc::ptr_eq(&changed[f].channels[c], &state[f].channels[c]);
            if (0..state.len()).all(same) {
                return Vec::new();
            }
            let one = |row: &ResidualRow| {
                let (f, i) = (row.flight as usize, row.index as usize);
                (changed[f].channels[c][i] - state[f].channels[c][i]) * scale
            };
            let change: Vec<f64> = self.rows[c].iter().map(one).collect();
            if change.iter().all(|d| *d == 0.0) { Vec::new() } else { change }
        })
    }

    /// [`Problem::slope`] of several numbers, side by side.
    pub fn slopes(&self, state: &Predictions, x: &[f64], which: &[usize]) -> Vec<ChannelValues> {
        which.par_iter().map(|&k| self.slope(state, x, k)).collect()
    }
}

impl FlightRecord {
    /// First sample of value `i` of channel `c`, and one beyond its last.
    pub fn place(&self, c: usize, i: usize) -> [usize; 2] {
        match c {
            0..6 => self.bins[i],
            6..12 => self.windows[i],
            _ => [self.volts[i].0, self.volts[i].0 + 1],
        }
    }

    /// Whether value `i` of channel `c` follows the one before without a gap.
    fn adjoins(&self, c: usize, i: usize) -> bool {
        match c {
            0..6 => self.bins[i - 1][1] == self.bins[i][0],
            6..12 => self.windows[i - 1][1] == self.windows[i][0],
            _ => true,
        }
    }
}
