//! Thrust and drag together, from the specific force along all three body axes (paper Eq. 6, 7 and 9).

use super::rates::{Compared, TAUS_S, times};
use super::solve::{Solution, Unknown, solve};
use crate::base::stats::mean;
use crate::insight::estimate::range::{DRAG_1_M, TIME_CONSTANT_S};
use crate::insight::prepare::data::{Chosen, Data, DataPart};
use crate::model::dynamics::force_in_body;
use crate::model::thrust::specific_thrust;
use nalgebra::{DMatrix, DVector};

/// Which terms of the model are fitted; the others are zero, or given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// c0..c5 of Eq. 7.
    pub thrust: [bool; 6],
    /// Drag, with the constant offsets of the specific force along x and y beside it.
    pub drag: bool,
}

/// Order of the unknowns: time constant (s), c0..c5 (m/s2), drag along x, y, z (1/m), offsets along x, y (m/s2).
pub const TAU: usize = 0;
pub const THRUST: usize = 1;
pub const DRAG_AT: usize = 7;
pub const OFFSET: usize = 10;
const UNKNOWNS: usize = 12;

/// Measured and predicted specific force.
pub struct Force<'a> {
    data: &'a Data,
    terms: Terms,
    cutoff_hz: f64,
    /// Along x, y, z, of every flight, m/s2, smoothed.
    measured: [Vec<Vec<f64>>; 3],
    /// Voltage, V, or 0 where the terms leave it out.
    voltage: Vec<Vec<f64>>,
    /// Drag along x, y, z that is not fitted, 1/m.
    given_drag: [f64; 3],
}

impl<'a> Force<'a> {
    /// `bias` is the accelerometer's along x, y, z, m/s2; it is taken off.
    pub fn new(data: &'a Data, terms: Terms, bias: [f64; 3], given_drag: [f64; 3], cutoff_hz: f64) -> Self {
        let by_voltage = terms.thrust[4] || terms.thrust[5];
        let channel = |k: usize| {
            data.signals(|flight| {
                let force = flight.measured(3 + k).iter().map(|f| f - bias[k]).collect();
                flight.smooth(force, cutoff_hz)
            })
        };
        let voltage = data.signals(|f| if by_voltage { f.voltage.clone() } else { vec![0.0; f.time.len()] });
        Self { data, terms, cutoff_hz, measured: [0, 1, 2].map(channel), voltage, given_drag }
    }

    /// Channels in use: x and y tell drag only.
    fn axes(&self) -> &'static [usize] {
        if self.terms.drag { &[0, 1, 2] } else { &[2] }
    }

    /// The thrust command in [-1, 1] behind its lag.
    fn command(&self, tau: f64) -> Vec<Vec<f64>> {
        self.data.signals(|flight| flight.response(3, tau, 0.0).iter().map(|u| 2.0 * u - 1.0).collect())
    }

    /// Specific force along each axis, m/s2, smoothed like the measurement.
    fn predicted(&self, x: &[f64]) -> [Vec<Vec<f64>>; 3] {
        let thrust: [f64; 6] = std::array::from_fn(|k| x[THRUST + k]);
        let drag: [f64; 3] = std::array::from_fn(|k| if self.terms.drag { x[DRAG_AT + k] } else { self.given_drag[k] });
        let draggy = drag.iter().any(|k| *k > 0.0);
        let command = self.command(x[TAU]);
        let mut out: [Vec<Vec<f64>>; 3] = Default::default();
        for (f, flight) in self.data.flights.iter().enumerate() {
            let mut force: [Vec<f64>; 3] = Default::default();
            for (i, u) in command[f].iter().enumerate() {
                // A log without velocity is predicted as if it stood still.
                let v = if draggy { [0, 1, 2].map(|k| flight.velocity[k][i]) } else { [0.0; 3] };
                let [fx, fy, fz] = force_in_body(&thrust, &drag, *u, self.voltage[f][i], v);
                force[0].push(fx + x[OFFSET]);
                force[1].push(fy + x[OFFSET + 1]);
                force[2].push(fz);
            }
            for (out, force) in out.iter_mut().zip(force) {
                out.push(flight.smooth(force, self.cutoff_hz));
            }
        }
        out
    }

    fn choose(&self, part: DataPart) -> Chosen {
        let mut x = [0.0; UNKNOWNS];
        x[TAU] = TAUS_S[0];
        x[THRUST + 5] = 1.0;
        x[DRAG_AT..DRAG_AT + 3].fill(1.0);
        let predicted = self.predicted(&x);
        let known = |f: usize, i: usize| {
            self.axes().iter().all(|&k| self.measured[k][f][i].is_finite() && predicted[k][f][i].is_finite())
        };
        self.data.choose(part, known)
    }

    /// c0..c5 by linear least squares on the vertical specific force at this time constant, without drag; and what is
    /// left.
    fn linear(&self, tau: f64, chosen: &Chosen) -> Option<([f64; 6], f64)> {
        let used: Vec<usize> = (0..6).filter(|&k| self.terms.thrust[k]).collect();
        let (u, v) = (Data::pick(&self.command(tau), chosen), Data::pick(&self.voltage, chosen));
        let measured = Data::pick(&self.measured[2], chosen);
        let regressor = |i: usize, k: usize| {
            let mut unit = [0.0; 6];
            unit[k] = 1.0;
            specific_thrust(&unit, u[i], v[i])
        };
        let n = used.len();
        let sum = |f: &dyn Fn(usize) -> f64| (0..u.len()).map(f).sum::<f64>();
        let normal = DMatrix::from_fn(n, n, |a, b| sum(&|i| regressor(i, used[a]) * regressor(i, used[b])));
        let right = DVector::from_fn(n, |a, _| sum(&|i| regressor(i, used[a]) * measured[i]));
        let found = normal.cholesky()?.solve(&right);
        let mut c = [0.0; 6];
        used.iter().zip(found.iter()).for_each(|(&k, value)| c[k] = *value);
        let left =
            mean(&(0..u.len()).map(|i| (measured[i] - specific_thrust(&c, u[i], v[i])).powi(2)).collect::<Vec<_>>());
        Some((c, left))
    }

    /// Fits all unknowns of the terms; the others stay at zero with no width.
    /// `near` is a solution to start from.
    pub fn fit(&self, part: DataPart, near: Option<&Solution>) -> Option<Solution> {
        let chosen = self.choose(part);
        let thinned: Chosen = chosen.iter().map(|c| c.iter().copied().step_by(7).collect()).collect();
        let starts = TAUS_S.iter().filter_map(|&tau| self.linear(tau, &thinned).map(|(c, left)| (left, tau, c)));
        let (_, tau, c) = starts.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let blocks = self.data.blocks(&chosen);
        let fixed = Unknown { start: 0.0, low: 0.0, high: 0.0, step: 0.0, linear: true };
        let mut unknowns = vec![fixed; UNKNOWNS];
        unknowns[TAU] =
            Unknown { start: tau, low: TIME_CONSTANT_S[0], high: TIME_CONSTANT_S[1], step: 2e-5, linear: false };
        for k in (0..6).filter(|&k| self.terms.thrust[k]) {
            unknowns[THRUST + k] = Unknown { start: c[k], low: -1e4, high: 1e4, step: 1e-3, linear: true };
        }
        if self.terms.drag {
            unknowns[DRAG_AT..DRAG_AT + 3].fill(Unknown {
                start: 0.02,
                low: DRAG_1_M[0],
                high: DRAG_1_M[1],
                step: 1e-4,
                linear: false,
            });
            unknowns[OFFSET..].fill(Unknown { start: 0.0, low: -5.0, high: 5.0, step: 1e-3, linear: true });
        }
        // Only what moves is handed on.
        let moving: Vec<usize> = (0..UNKNOWNS).filter(|&i| unknowns[i].high > unknowns[i].low).collect();
        let whole = |part: &[f64]| {
            let mut x = vec![0.0; UNKNOWNS];
            moving.iter().zip(part).for_each(|(&i, value)| x[i] = *value);
            x
        };
        let measured: Vec<Vec<f64>> = self.axes().iter().map(|&k| Data::pick(&self.measured[k], &chosen)).collect();
        let residuals = |x: &[f64]| {
            let predicted = self.predicted(&whole(x));
            let channel = |(n, &k): (usize, &usize)| {
                Data::pick(&predicted[k], &chosen).iter().zip(&measured[n]).map(|(p, m)| p - m).collect()
            };
            self.axes().iter().enumerate().map(channel).collect::<Vec<Vec<f64>>>()
        };
        let start = |i: usize| near.map_or(unknowns[i].start, |near| near.values[i]);
        let moved: Vec<Unknown> = moving.iter().map(|&i| Unknown { start: start(i), ..unknowns[i] }).collect();
        let found = solve(&moved, &blocks, &residuals)?;
        let mut out = Solution {
            values: whole(&found.values),
            covariance: DMatrix::zeros(UNKNOWNS, UNKNOWNS),
            at_bound: vec![false; UNKNOWNS],
            noise: found.noise,
        };
        for (a, &i) in moving.iter().enumerate() {
            out.at_bound[i] = found.at_bound[a];
            for (b, &j) in moving.iter().enumerate() {
                out.covariance[(i, j)] = found.covariance[(a, b)];
            }
        }
        Some(out)
    }

    /// Measured and predicted specific force along `axis`, m/s2, and when.
    pub fn compare(&self, part: DataPart, fit: &Solution, axis: usize) -> Compared {
        let chosen = self.choose(part);
        let predicted = self.predicted(&fit.values);
        Compared {
            time: times(self.data, &chosen),
            measured: Data::pick(&self.measured[axis], &chosen),
            predicted: Data::pick(&predicted[axis], &chosen),
        }
    }

    /// 1 and 99 % of the thrust command in [-1, 1], behind its lag, in flight.
    pub fn flown(&self, tau: f64) -> [f64; 2] {
        let u = Data::pick(&self.command(tau), &self.choose(DataPart::All));
        [0.01, 0.99].map(|q| crate::base::stats::quantile(&u, q))
    }
}
