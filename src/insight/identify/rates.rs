//! One rate axis: time constant, gain and offset of its first-order response (paper Eq. 6 and section 4.1), and what it
//! has beside that.

use super::solve::{Solution, Unknown, solve};
use crate::base::stats::{Score, correlation, mean};
use crate::insight::estimate::range::{RATE_GAIN, TIME_CONSTANT_S};
use crate::insight::prepare::data::{Chosen, Data, DataPart};
use crate::insight::prepare::lag::Following;
use crate::insight::prepare::lately::Lately;
use std::sync::Arc;

/// Time constants to start from.
pub const TAUS_S: [f64; 8] = [0.001, 0.004, 0.008, 0.015, 0.03, 0.06, 0.12, 0.25];
/// Fewer of them, with delays (s), limits (s2/rad), and natural frequencies (rad/s) and dampings of a second order to
/// start from, where these are looked for as well.
const FEWER_TAUS_S: [f64; 3] = [0.006, 0.02, 0.06];
const DELAYS_S: [f64; 4] = [0.005, 0.02, 0.04, 0.07];
const SLEWS_S2_RAD: [f64; 3] = [1.0 / 800.0, 1.0 / 250.0, 1.0 / 80.0];
const NATURAL_RAD_S: [f64; 4] = [12.0, 20.0, 35.0, 70.0];
const DAMPING: [f64; 2] = [0.2, 0.7];
const DELAY_MOST_S: f64 = 0.15;
const INERTIA_MOST_S2: f64 = 0.02;
const SLEW_MOST_S2_RAD: f64 = 0.2;

/// What a response has beside its lag; 0 is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BesideLag {
    /// Delay, s.
    pub delay: f64,
    /// One over the largest angular acceleration, s2/rad.
    pub slew: f64,
    /// T2 of a second order, s2.
    pub inertia: f64,
}

/// What of it is to be found; the rest is as given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LookedFor {
    #[default]
    Nothing,
    Delay,
    DelayAndLimit,
    SecondOrder,
}

/// Order of the values of a fit: time constant (s), gain (1), offset (rad/s), and what was looked for: delay (s) and
/// limit (s2/rad), or T2 (s2).
pub const GAIN: usize = 1;
pub const OFFSET: usize = 2;
pub const DELAY: usize = 3;
pub const SLEW: usize = 4;
pub const INERTIA: usize = 3;

impl BesideLag {
    /// The same with what was found in a fit with values `x`.
    fn with(self, look: LookedFor, x: &[f64]) -> Self {
        match look {
            LookedFor::Nothing => self,
            LookedFor::Delay => Self { delay: x[DELAY], ..self },
            LookedFor::DelayAndLimit => Self { delay: x[DELAY], slew: x[SLEW], ..self },
            LookedFor::SecondOrder => Self { inertia: x[INERTIA], ..self },
        }
    }

    /// The response to a setpoint with the values `x` of a fit. A limit of the response is one of its setpoint through
    /// the gain.
    pub fn following(self, x: &[f64]) -> Following {
        Following { tau: x[0], delay: self.delay, slew: self.slew * x[GAIN], inertia: self.inertia }
    }
}

/// Measured and predicted rates of one axis.
pub struct RateAxis<'a> {
    data: &'a Data,
    /// 0 roll, 1 pitch, 2 yaw.
    axis: usize,
    cutoff_hz: f64,
    /// Rate of every flight, rad/s, smoothed.
    measured: Vec<Vec<f64>>,
    /// Responses of every flight with gain 1 and no offset, rad/s, smoothed like the measurement.
    responses: Lately<Following, Vec<Vec<f64>>>,
}

/// Responses that are kept: those of one step of a fit.
const RESPONSES: usize = 8;

impl<'a> RateAxis<'a> {
    pub fn new(data: &'a Data, axis: usize, cutoff_hz: f64) -> Self {
        let measured = data.signals(|flight| flight.smooth(flight.measured(axis), cutoff_hz));
        Self { data, axis, cutoff_hz, measured, responses: Lately::new(RESPONSES) }
    }

    fn response(&self, by: Following) -> Arc<Vec<Vec<f64>>> {
        let all = || self.data.signals(|flight| flight.smooth(flight.response(self.axis, by), self.cutoff_hz));
        self.responses.get(by, all)
    }

    fn choose(&self, part: DataPart) -> Chosen {
        let response = self.response(Following { tau: TAUS_S[0], delay: DELAY_MOST_S, ..Following::default() });
        self.data.choose(part, |f, i| self.measured[f][i].is_finite() && response[f][i].is_finite())
    }

    /// Fits time constant, gain, offset, and what of `beside` is looked for.
    pub fn fit(&self, part: DataPart, beside: BesideLag, look: LookedFor) -> Option<Solution> {
        let chosen = self.choose(part);
        let (measured, blocks) = (Data::pick(&self.measured, &chosen), self.data.blocks(&chosen));
        let residuals = |x: &[f64]| {
            let response = Data::pick(&self.response(beside.with(look, x).following(x)), &chosen);
            vec![response.iter().zip(&measured).map(|(r, m)| x[GAIN] * r + x[OFFSET] - m).collect::<Vec<f64>>()]
        };
        let (_, start) = self.start(&chosen, &measured, beside, look)?;
        let tau =
            Unknown { start: start[0], low: TIME_CONSTANT_S[0], high: TIME_CONSTANT_S[1], step: 2e-5, linear: false };
        let limited = beside.slew > 0.0 || look == LookedFor::DelayAndLimit;
        let gain = Unknown { start: 1.0, low: RATE_GAIN[0], high: RATE_GAIN[1], step: 1e-3, linear: !limited };
        let offset = Unknown { start: 0.0, low: -2.0, high: 2.0, step: 1e-3, linear: true };
        let mut unknowns = vec![tau, gain, offset];
        // A step of the delay below the sampling would see no change at most samples.
        let more = match look {
            LookedFor::SecondOrder => [(INERTIA_MOST_S2, 1e-5)].as_slice(),
            _ => &[(DELAY_MOST_S, 1e-3), (SLEW_MOST_S2_RAD, 5e-5)],
        };
        for (&start, &(high, step)) in start[DELAY.min(start.len())..].iter().zip(more) {
            unknowns.push(Unknown { start, low: 0.0, high, step, linear: false });
        }
        solve(&unknowns, &blocks, &residuals)
    }

    /// Where to start from, and the mean square that is left there.
    fn start(&self, chosen: &Chosen, measured: &[f64], beside: BesideLag, look: LookedFor) -> Option<(f64, Vec<f64>)> {
        let left = |x: &Vec<f64>| {
            let response = Data::pick(&self.response(beside.with(look, x).following(x)), chosen);
            // Gain and offset are those of the line through both.
            mean_square(measured) * (1.0 - correlation(measured, &response).powi(2))
        };
        starts(look).into_iter().map(|x| (left(&x), x)).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The error that is left on `part` by the best of the starts of a fit, as a share of what `plain` leaves: whether
    /// a fit is worth its time.
    pub fn promise(&self, part: DataPart, plain: &Solution, look: LookedFor) -> Option<f64> {
        let chosen = self.choose(part);
        let measured = Data::pick(&self.measured, &chosen);
        let (left, _) = self.start(&chosen, &measured, BesideLag::default(), look)?;
        Some(left.sqrt() / self.score(part, plain, BesideLag::default()).rmse)
    }

    /// How well a fit predicts `part`, in rad/s.
    pub fn score(&self, part: DataPart, fit: &Solution, beside: BesideLag) -> Score {
        let chosen = self.choose(part);
        let predicted = Data::pick(&self.response(beside.following(&fit.values)), &chosen);
        let predicted: Vec<f64> = predicted.iter().map(|r| fit.values[GAIN] * r + fit.values[OFFSET]).collect();
        Score::of(&Data::pick(&self.measured, &chosen), &predicted)
    }
}

/// About the mean.
fn mean_square(x: &[f64]) -> f64 {
    let middle = mean(x);
    mean(&x.iter().map(|x| (x - middle).powi(2)).collect::<Vec<_>>())
}

/// Values to start from.
fn starts(look: LookedFor) -> Vec<Vec<f64>> {
    let late = || DELAYS_S.iter().flat_map(|&delay| FEWER_TAUS_S.map(|tau| vec![tau, 1.0, 0.0, delay]));
    match look {
        LookedFor::Nothing => TAUS_S.map(|tau| vec![tau, 1.0, 0.0]).to_vec(),
        LookedFor::Delay => late().collect(),
        LookedFor::DelayAndLimit => late().flat_map(|x| SLEWS_S2_RAD.map(|slew| [&x[..], &[slew]].concat())).collect(),
        LookedFor::SecondOrder => NATURAL_RAD_S
            .iter()
            .flat_map(|wn| DAMPING.map(|zeta| vec![2.0 * zeta / wn, 1.0, 0.0, 1.0 / (wn * wn)]))
            .collect(),
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
