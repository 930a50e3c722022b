//! From the collective command to the mean motor output: what a flight controller's mixer makes of it, beside what it
//! adds for rates, boosts and compensates.

use super::rates::TAUS_S;
use super::solve::{Solution, Unknown, solve};
use crate::base::stats::{Score, mean};
use crate::flight::series::held;
use crate::insight::criteria::identified::{CALM, CALM_LEAST};
use crate::insight::criteria::shown::REMARKED_ERROR;
use crate::insight::estimate::range::TIME_CONSTANT_S;
use crate::insight::prepare::data::{Chosen, Data, DataPart};
use crate::insight::prepare::flight::PreparedFlight;
use crate::insight::prepare::lag::Following;
use crate::insight::prepare::rotors::columns;
use crate::model::vehicle::identified::RotorChain;

/// Order of the unknowns: lag (s), output at no command, gain, its change (1/V) where there is a voltage, power of the
/// command where that is no line.
const LAG: usize = 0;
const ZERO: usize = 1;
const GAIN: usize = 2;

/// What the power can be: outputs are rotor speeds for commands of thrust at a half, the other way round at 2.
const POWERS: [f64; 2] = [0.3, 3.0];

/// What was found.
pub struct Mixer {
    pub chain: RotorChain,
    pub solution: Solution,
    /// Of the mean motor output, 0..1, on the same samples.
    pub score: Score,
}

/// Fits the mean motor output to the collective command. `None` where a flight lacks either, or where the command does
/// not reach the motors. A mixer that makes room for turns moves the mean output up near closed throttle and down near
/// full: where the flight is long enough, only what is calm is fitted, else that is noise that outliers do not rule.
pub fn fit(data: &Data, part: DataPart, by_voltage: bool) -> Option<Mixer> {
    let outputs = data.flights.iter().map(output).collect::<Option<Vec<_>>>()?;
    let known = |f: usize, i: usize| outputs[f][i].is_finite() && data.flights[f].time[i].is_finite();
    let calm = data.signals(calm);
    let [all, calm] = [&|_, _| true, &|f: usize, i: usize| calm[f][i] > 0.0] as [&dyn Fn(usize, usize) -> bool; 2];
    let [all, calm] = [all, calm].map(|also| data.choose(part, |f, i| known(f, i) && also(f, i)));
    let count = |chosen: &Chosen| chosen.iter().map(Vec::len).sum::<usize>() as f64;
    let chosen = if count(&calm) > CALM_LEAST.get() * count(&all) { calm } else { all };
    let voltage = |f: &PreparedFlight| if by_voltage { f.voltage.clone() } else { vec![0.0; f.time.len()] };
    let volts = Data::pick(&data.signals(voltage), &chosen);
    let middle = mean(&volts);
    let measured = Data::pick(&outputs, &chosen);
    let command = |lag: f64| Data::pick(&data.signals(|flight| flight.response(3, Following::lag(lag))), &chosen);
    let first = command(TAUS_S[0]);
    if first.is_empty() || first.iter().any(|u| !u.is_finite()) || middle.is_nan() {
        return None;
    }
    let chain = |x: &[f64], curved: bool| RotorChain {
        motor_offset: x[ZERO],
        motor_gain: x[GAIN],
        motor_power: if curved { x[x.len() - 1] } else { 1.0 },
        motor_gain_per_v: if by_voltage { x[GAIN + 1] } else { 0.0 },
        motor_at_v: middle,
        ..RotorChain::DIRECT
    };
    let predicted = |x: &[f64], curved: bool| -> Vec<f64> {
        let chain = chain(x, curved);
        command(x[LAG]).iter().zip(&volts).map(|(&u, &v)| chain.motor(u, v)).collect()
    };
    let free = |start: f64, [low, high]: [f64; 2]| Unknown { start, low, high, step: 1e-3, linear: true };
    let fitted = |curved: bool| -> Option<Mixer> {
        let lag = Unknown { step: 1e-4, linear: false, ..free(0.005, TIME_CONSTANT_S) };
        let mut unknowns = vec![lag, free(0.0, [-1.0, 1.0]), free(1.0, [0.02, 5.0])];
        unknowns.extend(by_voltage.then(|| free(0.0, [-1.0, 1.0])));
        unknowns.extend(curved.then(|| Unknown { linear: false, ..free(1.0, POWERS) }));
        let off = |x: &[f64]| vec![predicted(x, curved).iter().zip(&measured).map(|(p, m)| p - m).collect()];
        let solution = solve(&unknowns, &data.blocks(&chosen), &off)?;
        let x = &solution.values;
        let lag = if solution.at_bound[LAG] { 0.0 } else { x[LAG] };
        let score = Score::of(&measured, &predicted(x, curved));
        Some(Mixer { chain: RotorChain { command_lag_s: Some(lag), ..chain(x, curved) }, solution, score })
    };
    let line = fitted(false)?;
    // Nothing may tell a curve from a line, and beyond what was flown it is carried on.
    let better = |curved: &Mixer| {
        let power = curved.solution.values.len() - 1;
        let sure = (curved.chain.motor_power - 1.0).abs() > 2.0 * curved.solution.half_width(power);
        sure && curved.score.rmse < REMARKED_ERROR.get() * line.score.rmse
    };
    let best = fitted(true).filter(better).unwrap_or(line);
    (best.score.r2 > 0.0 && !best.solution.at_bound[GAIN]).then_some(best)
}

/// 1 where the rates are near their setpoints, else 0.
fn calm(flight: &PreparedFlight) -> Vec<f64> {
    let mut behind = vec![0.0; flight.time.len()];
    for axis in 0..3 {
        let (wanted, measured) = (flight.response(axis, Following::lag(TAUS_S[0])), flight.measured(axis));
        let most = wanted.iter().map(|rate| rate.abs()).fold(1e-3, f64::max);
        behind.iter_mut().zip(wanted.iter().zip(&measured)).for_each(|(b, (w, m))| *b += (w - m).abs() / most);
    }
    behind.into_iter().map(|b| if b < CALM.get() { 1.0 } else { 0.0 }).collect()
}

/// Mean motor output on the IMU's clock, 0..1.
pub fn output(flight: &PreparedFlight) -> Option<Vec<f64>> {
    let motors = &flight.quality.log.motors;
    let columns = columns(motors)?;
    let mean = |i: usize| columns.iter().map(|m| m[i]).sum::<f64>() / columns.len() as f64;
    let means: Vec<f64> = (0..motors.len()).map(mean).collect();
    Some(held(&motors.time_s, &means, &flight.time))
}
