//! One rate axis: time constant, gain and offset of its first-order response (paper Eq. 6 and section 4.1).

use super::solve::{Solution, Unknown, solve};
use crate::base::stats::{Score, mean};
use crate::insight::estimate::range::{RATE_GAIN, TIME_CONSTANT_S};
use crate::insight::prepare::data::{Chosen, Data, DataPart};

/// Time constants to start from.
pub const TAUS_S: [f64; 8] = [0.001, 0.004, 0.008, 0.015, 0.03, 0.06, 0.12, 0.25];
/// Delays to start from when asking whether one is missing, s.
const DELAYS_S: [f64; 4] = [0.005, 0.02, 0.04, 0.07];
const DELAY_MOST_S: f64 = 0.15;

/// Measured and predicted rates of one axis.
pub struct RateAxis<'a> {
    data: &'a Data,
    /// 0 roll, 1 pitch, 2 yaw.
    axis: usize,
    cutoff_hz: f64,
    /// Rate of every flight, rad/s, smoothed.
    measured: Vec<Vec<f64>>,
}

impl<'a> RateAxis<'a> {
    pub fn new(data: &'a Data, axis: usize, cutoff_hz: f64) -> Self {
        let measured = data.signals(|flight| flight.smooth(flight.measured(axis), cutoff_hz));
        Self { data, axis, cutoff_hz, measured }
    }

    /// The response with gain 1 and no offset, rad/s, smoothed like the measurement.
    fn response(&self, tau: f64, delay: f64) -> Vec<Vec<f64>> {
        self.data.signals(|flight| flight.smooth(flight.response(self.axis, tau, delay), self.cutoff_hz))
    }

    fn choose(&self, part: DataPart) -> Chosen {
        let response = self.response(TAUS_S[0], DELAY_MOST_S);
        self.data.choose(part, |f, i| self.measured[f][i].is_finite() && response[f][i].is_finite())
    }

    /// Fits time constant (s), gain (1), offset (rad/s) and, with `delay`, a pure delay (s).
    pub fn fit(&self, part: DataPart, delay: bool) -> Option<Solution> {
        let chosen = self.choose(part);
        let (measured, blocks) = (Data::pick(&self.measured, &chosen), self.data.blocks(&chosen));
        let residuals = |x: &[f64]| {
            let response = Data::pick(&self.response(x[0], x.get(3).copied().unwrap_or(0.0)), &chosen);
            vec![response.iter().zip(&measured).map(|(r, m)| x[1] * r + x[2] - m).collect::<Vec<f64>>()]
        };
        let delays = if delay { &DELAYS_S[..] } else { &[0.0] };
        let starts = delays.iter().flat_map(|&delay| TAUS_S.map(|tau| [tau, delay]));
        let cost = |x: &[f64; 2]| {
            let r = &residuals(&[x[0], 1.0, 0.0, x[1]])[0];
            mean(&r.iter().map(|r| r * r).collect::<Vec<_>>())
        };
        let [tau, late] = starts.map(|x| (cost(&x), x)).min_by(|a, b| a.0.total_cmp(&b.0))?.1;
        let mut unknowns = vec![
            Unknown { start: tau, low: TIME_CONSTANT_S[0], high: TIME_CONSTANT_S[1], step: 2e-5, linear: false },
            Unknown { start: 1.0, low: RATE_GAIN[0], high: RATE_GAIN[1], step: 1e-3, linear: true },
            Unknown { start: 0.0, low: -2.0, high: 2.0, step: 1e-3, linear: true },
        ];
        if delay {
            // A step below the sampling would see no change at most samples.
            unknowns.push(Unknown { start: late, low: 0.0, high: DELAY_MOST_S, step: 1e-3, linear: false });
        }
        solve(&unknowns, &blocks, &residuals)
    }

    /// How well a fit predicts `part`, in rad/s.
    pub fn score(&self, part: DataPart, fit: &Solution) -> Score {
        let chosen = self.choose(part);
        let [tau, gain, offset] = [fit.values[0], fit.values[1], fit.values[2]];
        let predicted = Data::pick(&self.response(tau, fit.values.get(3).copied().unwrap_or(0.0)), &chosen);
        let predicted: Vec<f64> = predicted.iter().map(|r| gain * r + offset).collect();
        Score::of(&Data::pick(&self.measured, &chosen), &predicted)
    }
}

/// Times of the chosen samples, s since the start of their log.
pub fn times(data: &Data, chosen: &Chosen) -> Vec<f64> {
    Data::pick(&data.signals(|flight| flight.time.clone()), chosen)
}

/// A channel, measured and predicted.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    pub time: Vec<f64>,
    pub measured: Vec<f64>,
    pub predicted: Vec<f64>,
}
