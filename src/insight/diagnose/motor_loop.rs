//! How a flight controller answers an error of its roll and pitch rates, by what it sends to the motors, and how that
//! turns the vehicle. Those outputs are clean where a gyro is noisy: behind the motors' lag they also tell how it
//! turns, so that only the scale of rate and acceleration is taken from the gyro.
//!
//! The vehicle turns by `w' = a v` with `tau v' = u - v`, u the outputs' squares in the pattern of the axis; the loop
//! answers by `du = gain a d(int v) + g1 d(a v) + g2 d(setpoint)` over [`ANSWER_S`].

mod late;
mod outputs;
mod plant;

use crate::base::stats::{mean, median, robust_sd};
use crate::flight::Log;
use crate::flight::series::held;
use crate::flight::spans::Span;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use crate::insight::estimate::jackknife::jackknife;
use crate::insight::estimate::robust::huber;
pub use late::MotorsLate;
use nalgebra::{DMatrix, DVector};
use outputs::Outputs;
pub use plant::TurningPlant;
use plant::plants;

/// Vehicles of more motors make up for a weak one with several, and turn by other patterns.
pub const FOUR: usize = 4;
/// Roll and pitch, whose gains are told.
pub const AXES: usize = 2;
/// Outputs are compared with those so long before, s: an integrator hardly moves meanwhile.
const ANSWER_S: f64 = 0.016;
/// Delays of commands, s.
const DELAYS_S: [f64; 6] = [0.0, 0.004, 0.008, 0.012, 0.02, 0.03];
/// Steps of the robust fit, its bound in standard deviations, and the share of an output that is as good as exact.
const REWEIGHTED: usize = 20;
const HUBER: f64 = 3.0;
const EXACT: f64 = 0.01;

/// The gain of a rate loop about one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateGain {
    /// Motor output, squared, that an error of 1 rad/s turns with.
    pub gain: f64,
    /// Its standard deviation.
    pub sd: f64,
    /// By how much the commands are late, s.
    pub delay_s: f64,
    /// Share of the squares of the outputs that errors and turns explain, 0..1.
    pub answered: f64,
}

/// A rate loop and what it turns.
#[derive(Clone, Debug)]
pub struct MotorLoop {
    /// Of roll, pitch and yaw.
    pub plants: [TurningPlant; 3],
    /// Of roll and pitch; none where the outputs do not tell them.
    pub gains: Option<[RateGain; AXES]>,
    /// Middle of the voltage, V; NaN where the log has none.
    pub volts: f64,
}

/// Of a flight; none where the outputs of four motors or the rates are not known.
pub fn motor_loop(log: &Log, usable: &[Span]) -> Option<MotorLoop> {
    let outputs = Outputs::new(&log.motors, usable)?;
    let plants = plants(&outputs, log)?;
    // Commands are as late about one axis as about the other.
    let at = |delay_s: f64| {
        let [roll, pitch] = [0, 1].map(|k| about(&outputs, log, &plants[k], k, delay_s));
        Some([roll?, pitch?])
    };
    let left = |gains: &[RateGain; AXES]| gains.iter().map(|g| 1.0 - g.answered).product::<f64>();
    let gains = DELAYS_S.into_iter().filter_map(at).min_by(|a, b| left(a).total_cmp(&left(b)));
    let volts: Vec<f64> = log.battery.column(0).into_iter().filter(|v| v.is_finite()).collect();
    Some(MotorLoop { plants, gains, volts: median(&volts) })
}

/// The law about axis `k`, with commands that are late by so much.
fn about(outputs: &Outputs, log: &Log, plant: &TurningPlant, k: usize, delay_s: f64) -> Option<RateGain> {
    let [behind, sum] = outputs.lagged(plant.pattern, plant.lag_s);
    let (sent, rate): (Vec<f64>, Vec<f64>) = (log.setpoint.column(k), sum);
    let apart = outputs.apart(ANSWER_S);
    let late: Vec<f64> = outputs.time.iter().map(|t| t - delay_s).collect();
    let wanted = held(&log.setpoint.time_s, &sent, &late);
    let at = outputs.pairs(apart, |i| outputs.usable[i] && outputs.free[i] && wanted[i].is_finite());
    let moved = |x: &[f64], scale: f64| at.iter().map(|&i| scale * (x[i + apart] - x[i])).collect::<Vec<_>>();
    let columns = vec![moved(&rate, plant.authority), moved(&behind, plant.authority), moved(&wanted, 1.0)];
    let law = law(columns, moved(&outputs.turning[plant.pattern], 1.0), outputs.stretches(&at))?;
    Some(RateGain { delay_s, ..law })
}

/// Robust fit of the outputs `moved` by `columns`, the rate first; rows belong to a `stretch` of time each.
fn law(columns: Vec<Vec<f64>>, moved: Vec<f64>, stretch: Vec<u32>) -> Option<RateGain> {
    let n = columns.len();
    let blocks = *stretch.last()? as usize + 1;
    let mut weight = vec![1.0; moved.len()];
    let (mut size, mut left) = (DVector::zeros(n), moved.clone());
    for _ in 0..REWEIGHTED {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(&weight).map(|((a, b), w)| a * b * w).sum::<f64>();
        let square = DMatrix::from_fn(n, n, |i, j| product(&columns[i], &columns[j]));
        let along = DVector::from_fn(n, |i, _| product(&columns[i], &moved));
        size = inverse(&square, &vec![0.0; n])? * along;
        let one = |i: usize| moved[i] - (0..n).map(|j| size[j] * columns[j][i]).sum::<f64>();
        left = (0..moved.len()).map(one).collect();
        let sd = robust_sd(&left);
        let weigh = |(e, y): (&f64, &f64)| huber(e / (sd + EXACT * y.abs()).max(1e-12), HUBER);
        weight = left.iter().zip(&moved).map(weigh).collect();
    }
    let scaled = |x: &[f64]| vec![x.iter().zip(&weight).map(|(x, w)| x * w.sqrt()).collect::<Vec<f64>>()];
    let all: Vec<Vec<Vec<f64>>> = columns.iter().chain([&moved, &left]).map(|x| scaled(x)).collect();
    let grams = Grams::new(&all.iter().collect::<Vec<_>>(), &[stretch], blocks);
    let own: Vec<usize> = (0..n).collect();
    let (covariance, _) = jackknife(&grams, &own, n + 1, &vec![0.0; n], 1)?;
    let answered = 1.0 - grams.sum[(n + 1, n + 1)] / grams.sum[(n, n)];
    let known = RateGain { gain: size[0].abs(), sd: covariance[(0, 0)].sqrt(), delay_s: 0.0, answered };
    (known.gain > 0.0 && answered.is_finite()).then_some(known)
}

/// Several flights of one vehicle as one: the middle of what they say, as well as the worst of them says it. None where
/// one of them says nothing.
pub fn together(flights: &[Option<MotorLoop>]) -> Option<MotorLoop> {
    let flights: Vec<&MotorLoop> = flights.iter().map(Option::as_ref).collect::<Option<_>>()?;
    let first = *flights.first()?;
    let plant = |k: usize| {
        let of = |f: fn(&TurningPlant) -> f64| flights.iter().map(|l| f(&l.plants[k])).collect::<Vec<f64>>();
        let (authority, sd) = middle(&of(|p| p.authority.abs()), &of(|p| p.sd));
        let (lag_s, turned) = (mean(&of(|p| p.lag_s)), least(&of(|p| p.turned)));
        TurningPlant { authority, sd, lag_s, turned, ..first.plants[k] }
    };
    let gain = |k: usize| {
        let all = flights.iter().map(|l| Some(l.gains?[k])).collect::<Option<Vec<RateGain>>>()?;
        let of = |f: fn(&RateGain) -> f64| all.iter().map(f).collect::<Vec<f64>>();
        let (gain, sd) = middle(&of(|g| g.gain), &of(|g| g.sd));
        Some(RateGain { gain, sd, delay_s: mean(&of(|g| g.delay_s)), answered: least(&of(|g| g.answered)) })
    };
    let gains = gain(0).zip(gain(1)).map(|(roll, pitch)| [roll, pitch]);
    let volts = mean(&flights.iter().map(|l| l.volts).collect::<Vec<f64>>());
    Some(MotorLoop { plants: [0, 1, 2].map(plant), gains, volts })
}

/// The mean of what flights say, and its standard deviation by their own and by their spread.
fn middle(all: &[f64], sd: &[f64]) -> (f64, f64) {
    let (middle, n) = (mean(all), all.len() as f64);
    let root = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>().sqrt() / n;
    (middle, root(&mut all.iter().map(|x| x - middle)).hypot(root(&mut sd.iter().copied())))
}

fn least(x: &[f64]) -> f64 {
    x.iter().copied().fold(f64::INFINITY, f64::min)
}
