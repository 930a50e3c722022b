//! The room that a mixer makes for turns, from the motors' outputs: their mean is held between k e and 1 - k e, with e
//! the sum over the axes of |setpoint - response| (rad/s). Effect `mixer_room` of the simulator.

use super::estimate::Estimated;
use super::mixer;
use super::rate_loop::RateLoop;
use super::rates::GAIN;
use super::solve::Solution;
use crate::base::stats::NORMAL_95;
use crate::insight::criteria::shown::REMARKED_ERROR;
use crate::insight::prepare::data::{Data, DataPart};
use crate::insight::prepare::lag::Following;
use crate::model::dynamics::extended::throttle;
use crate::model::effects::with_room;
use crate::model::vehicle::identified::RotorChain;
use std::collections::BTreeMap;

/// Most that it can be, s/rad, and how fine it is looked for.
const MOST_S_RAD: f64 = 0.5;
const STEPS: usize = 60;

/// What the mean output is predicted from, sample by sample.
struct Room {
    block: Vec<u32>,
    output: Vec<f64>,
    throttle: Vec<f64>,
    /// Summed over the axes, rad/s.
    behind: Vec<f64>,
    /// From command to output, at the flight's middle voltage.
    chain: RotorChain,
}

/// Fits k to `part` of the flights, of which `chain`, `rates` and `rate_loop` were found. None where the motors do not
/// tell it: no outputs, or nothing gained by it.
pub fn fit(
    data: &Data,
    part: DataPart,
    chain: &RotorChain,
    rates: [&Solution; 3],
    rate_loop: &RateLoop,
) -> Option<Estimated> {
    let room = Room::new(data, part, chain, rates, rate_loop)?;
    let grid = (0..=STEPS).map(|i| MOST_S_RAD * (i as f64 / STEPS as f64).powi(2));
    let mut k = grid.map(|k| (room.squares(k), k)).min_by(|a, b| a.0.total_cmp(&b.0))?.1;
    let mut half_width = f64::INFINITY;
    for _ in 0..8 {
        let (step, deviation) = room.newton(k)?;
        k = (k + step).clamp(0.0, MOST_S_RAD);
        half_width = NORMAL_95 * deviation;
    }
    let gains = room.squares(k) < REMARKED_ERROR.get().powi(2) * room.squares(0.0);
    (gains && 2.0 * half_width < k && k < MOST_S_RAD).then(|| Estimated::new(k, half_width))
}

impl Room {
    fn new(
        data: &Data,
        part: DataPart,
        chain: &RotorChain,
        rates: [&Solution; 3],
        rate_loop: &RateLoop,
    ) -> Option<Self> {
        let outputs = data.flights.iter().map(mixer::output).collect::<Option<Vec<_>>>()?;
        let mut behind = data.signals(|flight| vec![0.0; flight.time.len()]);
        for (axis, fit) in rates.into_iter().enumerate() {
            let (gain, by) = (fit.values[GAIN], rate_loop.beside(axis).following(&fit.values));
            let held = Following::lag(1e-9);
            for (flight, sum) in data.flights.iter().zip(&mut behind) {
                let response = flight.response(axis, by);
                let wanted = flight.response(axis, held);
                let both = wanted.iter().zip(&response);
                sum.iter_mut().zip(both).for_each(|(sum, (w, r))| *sum += gain * (w - r).abs());
            }
        }
        let lag = chain.command_lag_s.unwrap_or(0.0).max(1e-9);
        let throttle = data.signals(|flight| flight.response(3, Following::lag(lag)));
        let known = |f: usize, i: usize| [&outputs, &throttle, &behind].iter().all(|x| x[f][i].is_finite());
        let chosen = data.choose(part, known);
        let pick = |x: &[Vec<f64>]| Data::pick(x, &chosen);
        let (output, throttle, behind) = (pick(&outputs), pick(&throttle), pick(&behind));
        Some(Self { block: data.blocks(&chosen), output, throttle, behind, chain: *chain })
    }

    fn residual(&self, i: usize, k: f64) -> f64 {
        let command = with_room(2.0 * self.throttle[i] - 1.0, k, self.behind[i]);
        self.output[i] - self.chain.motor(throttle(command), self.chain.motor_at_v)
    }

    fn squares(&self, k: f64) -> f64 {
        (0..self.output.len()).map(|i| self.residual(i, k).powi(2)).sum()
    }

    /// The Gauss-Newton step of k, and its standard deviation over stretches of time.
    fn newton(&self, k: f64) -> Option<(f64, f64)> {
        const STEP: f64 = 1e-4;
        let mut along: BTreeMap<u32, f64> = BTreeMap::new();
        let mut curvature = 0.0;
        for (i, block) in self.block.iter().enumerate() {
            let here = self.residual(i, k);
            let slope = (self.residual(i, k + STEP) - here) / STEP;
            *along.entry(*block).or_default() -= slope * here;
            curvature += slope * slope;
        }
        let (sum, squares) = along.values().fold((0.0, 0.0), |(sum, squares), g| (sum + g, squares + g * g));
        (curvature > 0.0).then(|| (sum / curvature, f64::sqrt(squares) / curvature))
    }
}
