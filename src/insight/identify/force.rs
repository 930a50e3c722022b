//! Thrust and drag together, from the specific force along all three body axes (paper Eq. 6, 7 and 9).

use super::force_terms::{DRAG_AT, ForceColumns, ForceTerms, OFFSET, POWER, TAU, THRUST, VALUES};
use super::inputs::Inputs;
use super::rates::TAUS_S;
use super::solve::{Solution, Unknown, solve_within};
use crate::base::stats::mean;
use crate::flight::lowpass::LowPass;
use crate::flight::series::period;
use crate::insight::criteria::identified::DRAG_RATIO;
use crate::insight::estimate::halfspace::{Halfspace, minimum};
use crate::insight::estimate::range::{DRAG_1_M, TIME_CONSTANT_S};
use crate::insight::prepare::data::{Chosen, Data, DataPart};
use crate::insight::prepare::flight::PreparedFlight;
use crate::model::dynamics::force_in_body;
use crate::model::thrust::shape::{self, MOST_VOLTAGE_POWER, ThrustLimit};
use crate::model::thrust::specific_thrust;
use nalgebra::DMatrix;

/// Slower than this, the voltage is what the model's discharge can follow, Hz; what is faster is the sag under load,
/// which the model has as part of the thrust curve.
const VOLTAGE_HZ: f64 = 0.5;
/// Least drag over mass of an axis, 1/m: without any, an ellipsoid has no size.
const LEAST_DRAG_1_M: f64 = 1e-4;

/// Power of the voltage to begin with: a motor at a given duty.
const SQUARED: f64 = 2.0;

/// Measured and predicted specific force.
pub struct Force<'a> {
    data: &'a Data,
    inputs: &'a Inputs,
    terms: ForceTerms,
    /// Along x, y, z, of every flight, m/s2, smoothed.
    measured: [Vec<Vec<f64>>; 3],
    /// Voltage, V, or 0 where the terms leave it out.
    voltage: Vec<Vec<f64>>,
}

impl<'a> Force<'a> {
    /// Of what the accelerometer measured; where `thrust` (m/s2, every flight) is given, along z of that.
    pub fn new(data: &'a Data, inputs: &'a Inputs, terms: ForceTerms, thrust: Option<&[Vec<f64>]>) -> Self {
        let channel = |k: usize| {
            let one = |(f, flight): (usize, &PreparedFlight)| {
                let force = match thrust {
                    Some(thrust) if k == 2 => thrust[f].clone(),
                    _ => flight.measured(3 + k).iter().map(|force| force - terms.bias[k]).collect(),
                };
                flight.smooth(force, terms.cutoff_hz)
            };
            data.flights.iter().enumerate().map(one).collect()
        };
        let voltage = data.signals(|f| if terms.by_voltage() { slow(f) } else { vec![0.0; f.time.len()] });
        Self { data, inputs, measured: [0, 1, 2].map(channel), terms, voltage }
    }

    /// The same with other terms of the same channels, bias and filter.
    pub fn with(&self, terms: ForceTerms) -> Self {
        Self { measured: self.measured.clone(), voltage: self.voltage.clone(), terms, ..*self }
    }

    pub fn terms(&self) -> &ForceTerms {
        &self.terms
    }

    /// Channels in use: x and y tell drag only.
    fn axes(&self) -> &'static [usize] {
        if self.terms.drag { &[0, 1, 2] } else { &[2] }
    }

    /// Thrust over mass of the curve `c`, the mean over what lifts, of every flight; with a `power` of the voltage,
    /// where the terms have one.
    fn thrust(&self, c: &[f64; 6], tau: f64, power: f64) -> Vec<Vec<f64>> {
        let one = |(f, flight): (usize, &PreparedFlight)| {
            let inputs = self.inputs.at(f, &flight.time, tau);
            let mean = |i: usize| {
                let v = self.voltage[f][i];
                let factor = self.terms.power_at_v.map_or(1.0, |at| (v / at).powf(power));
                factor * inputs.iter().map(|u| specific_thrust(c, u[i], v)).sum::<f64>() / inputs.len() as f64
            };
            (0..flight.time.len()).map(mean).collect()
        };
        self.data.flights.iter().enumerate().map(one).collect()
    }

    /// Specific force along each axis, m/s2, smoothed like the measurement.
    fn predicted(&self, x: &[f64]) -> [Vec<Vec<f64>>; 3] {
        let c: [f64; 6] = std::array::from_fn(|k| x[THRUST + k]);
        let given = self.terms.given_drag;
        let drag: [f64; 3] = std::array::from_fn(|k| if self.terms.drag { x[DRAG_AT + k] } else { given[k] });
        let draggy = drag.iter().any(|k| *k > 0.0);
        let thrust = self.thrust(&c, x[TAU], x[POWER]);
        let mut out: [Vec<Vec<f64>>; 3] = Default::default();
        for (f, flight) in self.data.flights.iter().enumerate() {
            let mut force: [Vec<f64>; 3] = Default::default();
            for (i, &lift) in thrust[f].iter().enumerate() {
                // A log without velocity is predicted as if it stood still.
                let v = if draggy { [0, 1, 2].map(|k| flight.velocity[k][i]) } else { [0.0; 3] };
                let [fx, fy, fz] = force_in_body(&[lift, 0.0, 0.0, 0.0, 0.0, 0.0], &drag, 0.0, 0.0, v);
                force[0].push(fx + x[OFFSET]);
                force[1].push(fy + x[OFFSET + 1]);
                force[2].push(fz);
            }
            for (out, force) in out.iter_mut().zip(force) {
                out.push(flight.smooth(force, self.terms.cutoff_hz));
            }
        }
        out
    }

    /// The samples of `part` at which everything is known.
    pub fn choose(&self, part: DataPart) -> Chosen {
        let mut x = [0.0; VALUES];
        x[TAU] = TAUS_S[0];
        x[THRUST + 5] = 1.0;
        x[DRAG_AT..DRAG_AT + 3].fill(1.0);
        let predicted = self.predicted(&x);
        let known = |f: usize, i: usize| {
            self.axes().iter().all(|&k| self.measured[k][f][i].is_finite() && predicted[k][f][i].is_finite())
        };
        self.data.choose(part, known)
    }

    /// Weights of the curves by linear least squares on the vertical specific force at this time constant, without drag
    /// and under `limits`; and what is left.
    fn linear(&self, tau: f64, chosen: &Chosen, limits: &[Halfspace]) -> Option<(Vec<f64>, f64)> {
        let signals: Vec<Vec<f64>> =
            self.terms.curves.iter().map(|c| Data::pick(&self.thrust(c, tau, SQUARED), chosen)).collect();
        let measured = Data::pick(&self.measured[2], chosen);
        let n = signals.len();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let normal = DMatrix::from_fn(n, n, |a, b| product(&signals[a], &signals[b]));
        let right: Vec<f64> = signals.iter().map(|signal| product(signal, &measured)).collect();
        let weights = minimum(&normal, &vec![0.0; n], &right, limits)?;
        let error = |i: usize| (0..n).map(|k| weights[k] * signals[k][i]).sum::<f64>() - measured[i];
        let left = mean(&(0..measured.len()).map(|i| error(i).powi(2)).collect::<Vec<_>>());
        Some((weights, left))
    }

    /// Limits of the curve, on the weights of its terms.
    fn limits(&self, flown: [f64; 2]) -> Vec<Halfspace> {
        let one = |limit: &ThrustLimit| Halfspace {
            row: self.terms.curves.iter().map(|c| c.iter().zip(limit.row).map(|(c, row)| c * row).sum()).collect(),
            least: limit.least,
        };
        shape::limits(self.terms.volts, self.terms.gravity, flown).iter().map(one).collect()
    }

    /// Fits the curve, its time constant where the inputs lag, and the drag, under the limits of a vehicle.
    pub fn fit(&self, part: DataPart) -> Option<Solution> {
        let chosen = self.choose(part);
        let limits = self.limits(self.inputs.flown(self.data, &chosen, TAUS_S[0]));
        let thinned: Chosen = chosen.iter().map(|c| c.iter().copied().step_by(7).collect()).collect();
        let taus = if self.inputs.lags() { &TAUS_S[..] } else { &TAUS_S[..1] };
        let starts = taus.iter().filter_map(|&tau| self.linear(tau, &thinned, &limits).map(|(w, left)| (left, tau, w)));
        let (_, tau, weights) = starts.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let unknowns = self.unknowns(tau, &weights);
        let layout = ForceColumns { terms: &self.terms, lags: self.inputs.lags() };
        let n = weights.len();
        let widened = |h: &Halfspace, at: usize| {
            let mut row = vec![0.0; unknowns.len()];
            row[at..at + h.row.len()].copy_from_slice(&h.row);
            Halfspace { row, least: h.least }
        };
        let first = usize::from(layout.lags);
        let mut within: Vec<Halfspace> = limits.iter().map(|h| widened(h, first)).collect();
        if self.terms.drag {
            within.extend(drag_limits().iter().map(|h| widened(h, first + n)));
        }
        let measured: Vec<Vec<f64>> = self.axes().iter().map(|&k| Data::pick(&self.measured[k], &chosen)).collect();
        let residuals = |x: &[f64]| {
            let predicted = self.predicted(&layout.values(x));
            let channel = |(n, &k): (usize, &usize)| {
                Data::pick(&predicted[k], &chosen).iter().zip(&measured[n]).map(|(p, m)| p - m).collect()
            };
            self.axes().iter().enumerate().map(channel).collect::<Vec<Vec<f64>>>()
        };
        let found = solve_within(&unknowns, &within, &self.data.blocks(&chosen), &residuals)?;
        Some(layout.solution(&found))
    }

    fn unknowns(&self, tau: f64, weights: &[f64]) -> Vec<Unknown> {
        let mut out = Vec::new();
        if self.inputs.lags() {
            let [low, high] = TIME_CONSTANT_S;
            out.push(Unknown { start: tau, low, high, step: 2e-5, linear: false });
        }
        let weight = |&start: &f64| Unknown { start, low: -1e4, high: 1e4, step: 1e-3, linear: true };
        out.extend(weights.iter().map(weight));
        if self.terms.drag {
            let (low, high) = (LEAST_DRAG_1_M, DRAG_1_M[1]);
            out.extend([Unknown { start: 0.02, low, high, step: 1e-4, linear: false }; 3]);
            out.extend([Unknown { start: 0.0, low: -5.0, high: 5.0, step: 1e-3, linear: true }; 2]);
        }
        if self.terms.power_at_v.is_some() {
            out.push(Unknown { start: SQUARED, low: 0.0, high: MOST_VOLTAGE_POWER, step: 1e-2, linear: false });
        }
        out
    }

    /// 1 and 99 % of the mean input, behind a lag of `tau`, in flight.
    pub fn flown(&self, tau: f64) -> [f64; 2] {
        self.inputs.flown(self.data, &self.choose(DataPart::All), tau)
    }

    /// Thrust over mass by `c` at every sample, m/s2: what others can be fitted to.
    pub fn thrust_by(&self, solution: &Solution) -> Vec<Vec<f64>> {
        let c: [f64; 6] = std::array::from_fn(|k| solution.values[THRUST + k]);
        self.thrust(&c, solution.values[TAU], solution.values[POWER])
    }
}

/// Drag along no axis is a small share of that along another.
fn drag_limits() -> Vec<Halfspace> {
    let pairs = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).filter(|(i, j)| i != j);
    let limit = |(i, j): (usize, usize)| {
        let mut row = vec![0.0; 3];
        (row[i], row[j]) = (1.0, -1.0 / DRAG_RATIO.get());
        Halfspace { row, least: 0.0 }
    };
    pairs.map(limit).collect()
}

/// Lowest and highest voltage of the flights without what is faster than a discharge, or those of the pack, V.
pub fn flown_volts(data: &Data, pack: [f64; 2]) -> [f64; 2] {
    let all = data.flights.iter().flat_map(slow).filter(|v| v.is_finite());
    let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    if low <= high { [low.max(pack[0]), high.min(pack[1])] } else { pack }
}

/// The voltage without what is faster than a discharge, V.
fn slow(flight: &PreparedFlight) -> Vec<f64> {
    let mut voltage = flight.voltage.clone();
    if voltage.iter().all(|v| v.is_finite())
        && let Some(filter) = LowPass::new(VOLTAGE_HZ, period(&flight.time))
    {
        filter.run(&mut voltage);
    }
    voltage
}
