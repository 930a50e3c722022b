//! When the vehicle does not fly: it is not armed, has landed, or stands still.
//!
//! What the flight controller says of itself decides. Without it, stillness that no vehicle in the air has, and rotors
//! that do far less than carry it, tell. Of the latter, what the odometry sees moving fast is in the air: a fall
//! that drag holds at its speed does not seem to fall.

use super::{LogFinding, Severity};
use crate::base::stats::{mean, median};
use crate::flight::Log;
use crate::flight::series::{held, interpolated};
use crate::flight::spans::{Span, joined, length, without};
use crate::insight::criteria::usable::{
    END_MARGIN_S, IDLE_EFFORT, LANDING_S, LEAST_COMMAND, LOG_END_S, REST_FORCE, REST_RATE, RESTING_S,
    SHORTEST_FLIGHT_S, SLIDING_SPEED, STILL_FORCE, STILL_RATE, TAKE_OFF_MARGIN_S, TOUCH_DOWN_MARGIN_S,
};
use crate::model::constants::GRAVITY_M_S2;

/// Length over which standing still is judged, s.
const BIN_S: f64 = 0.1;
/// Gap of the odometry across which nothing is known of the speed, s.
const REACH_S: f64 = 0.5;
/// Bins to either side that tell whether it rests.
const NEIGHBOURS: usize = 5;

/// A tenth of a second.
struct Bin {
    span: Span,
    effort: f64,
    /// Neither turning nor falling.
    still: bool,
    /// The odometry says that it moves; not where there is none.
    slides: bool,
    /// Means of rates and specific force.
    means: [f64; 6],
}

/// Times at which it does not fly.
pub fn find(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let (start, end) = (log.imu.time_s[0], log.imu.time_s[log.imu.len() - 1]);
    let [disarmed, landed] = [0, 1].map(|k| not(log, k));
    let said = landed.is_some();
    let mut holes: Vec<Span> = landed.into_iter().chain(disarmed).flatten().collect();
    if !said {
        holes.extend(judged(log, findings));
    }
    let mut holes = joined(holes);
    for hole in &mut holes {
        *hole = [hole[0] - TOUCH_DOWN_MARGIN_S.get(), hole[1] + TAKE_OFF_MARGIN_S.get()];
        if hole[0] <= start + LOG_END_S.get() {
            hole[0] = start;
        }
        if hole[1] >= end - LOG_END_S.get() {
            hole[1] = end + BIN_S;
        }
    }
    let mut holes = joined(holes);
    for hole in &holes {
        let by = if said { ", as the flight controller says" } else { "" };
        let what = format!("{:.1} s on the ground{by}", hole[1] - hole[0]);
        findings.push(LogFinding::new(Severity::Note, "ground", "imu", what, "this time is left out").during(*hole));
    }
    if length(&without([start, end], &holes)) == 0.0 {
        let what = "the vehicle never flies".into();
        findings.push(LogFinding::new(Severity::Problem, "ground", "imu", what, "nothing can be identified"));
    }
    holes.push([end - END_MARGIN_S.get(), end + BIN_S]);
    joined(holes)
}

/// Times at which state `k` is known not to hold; `None` where the log never says. Before the first word of it the
/// first holds.
fn not(log: &Log, k: usize) -> Option<Vec<Span>> {
    let said = log.states.time_s.iter().zip(&log.states.rows).map(|(&time, row)| (time, row[k]));
    let said: Vec<(f64, f64)> = said.filter(|(_, value)| value.is_finite()).collect();
    let first = said.first()?.1;
    let mut spans = if first == 0.0 { vec![[f64::NEG_INFINITY, said[0].0]] } else { Vec::new() };
    for (i, &(from, value)) in said.iter().enumerate() {
        if value == 0.0 {
            spans.push([from, said.get(i + 1).map_or(f64::INFINITY, |next| next.0)]);
        }
    }
    Some(joined(spans))
}

/// How hard the rotors work: their speed where it was measured, else what the motors were sent, else the thrust
/// command; and the least of it that could carry a vehicle.
fn effort(log: &Log) -> Option<(Vec<f64>, f64)> {
    let some = |values: &[f64]| values.iter().any(|x| *x > 0.0);
    let (speeds, commands) = (log.rotors.means(), log.motors.means());
    let known = |values: &[f64]| values.iter().any(|x| x.is_finite());
    let (times, values, least) = if some(&speeds) {
        (&log.rotors.time_s, speeds, 0.0)
    } else if known(&commands) {
        (&log.motors.time_s, commands, LEAST_COMMAND.get())
    } else {
        (&log.setpoint.time_s, log.setpoint.column(3), LEAST_COMMAND.get())
    };
    known(&values).then(|| (held(times, &values, &log.imu.time_s), least))
}

/// Times at which it rests, or the rotors do far less than carry it and yet it neither turns nor falls.
fn judged(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let (start, end) = (log.imu.time_s[0], log.imu.time_s[log.imu.len() - 1]);
    let effort = effort(log);
    if let Some((effort, least)) = &effort
        && !effort.iter().any(|effort| effort > least)
    {
        return vec![[start, end + BIN_S]];
    }
    if effort.is_none() {
        let what = "no rotor speed, motor output or thrust command tells time on the ground".into();
        let so = "only time of perfect stillness is left out";
        findings.push(LogFinding::new(Severity::Note, "ground", "imu", what, so));
    }
    let bins = bins(log, effort.as_ref().map(|(effort, _)| &effort[..]));
    let rests: Vec<bool> = (0..bins.len()).map(|i| rests(&bins, i)).collect();
    let moving = bins.iter().zip(&rests).filter(|(bin, rests)| !**rests && bin.effort > 0.0).map(|(bin, _)| bin.effort);
    let moving: Vec<f64> = moving.collect();
    // A bump or two on a bench is no flight that tells what carries it.
    let flown = moving.len() as f64 * BIN_S >= SHORTEST_FLIGHT_S.get();
    let idle = if flown { IDLE_EFFORT.get() * median(&moving) } else { f64::NAN };
    let on_ground = |i: usize| {
        let bin = &bins[i];
        // Nothing is less than no number: a vehicle that never moves was never seen to need any effort.
        let works = bin.effort >= idle;
        let idles = bin.effort.is_nan() || bin.effort < idle;
        // An estimate that runs away does not make what rests fly.
        rests[i] && !works || effort.is_some() && bin.still && !bin.slides && idles
    };
    // A knock or two while being placed does not make a flight.
    let wide = (0..bins.len()).filter(|&i| on_ground(i)).map(|i| [bins[i].span[0] - BIN_S, bins[i].span[1] + BIN_S]);
    let still = joined(wide.collect()).into_iter().map(|span| [span[0] + BIN_S, span[1] - BIN_S]);
    let near = LOG_END_S.get();
    let at_an_end = |span: &Span| span[0] <= start + near || span[1] >= end - near;
    let landed = |span: &Span| span[1] - span[0] >= if at_an_end(span) { RESTING_S.get() } else { LANDING_S.get() };
    still.filter(landed).collect()
}

/// Whether the odometry moves as nothing on the ground does, at each sample of the IMU.
fn slides(log: &Log) -> Vec<bool> {
    let speeds = log.odometry.rows.iter().map(|row| row[7..].iter().map(|x| x * x).sum::<f64>().sqrt());
    let speeds = interpolated(&log.odometry.time_s, &speeds.collect::<Vec<_>>(), &log.imu.time_s, REACH_S);
    speeds.into_iter().map(|speed| speed > SLIDING_SPEED.get()).collect()
}

fn bins(log: &Log, effort: Option<&[f64]>) -> Vec<Bin> {
    let imu = &log.imu;
    let norm = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
    let slides = slides(log);
    let mut bins = Vec::new();
    let mut first = 0;
    while first < imu.len() {
        let from = imu.time_s[first];
        let n = imu.time_s[first..].partition_point(|&t| t < from + BIN_S);
        let rows = &imu.rows[first..first + n];
        let turning = mean(&rows.iter().map(|row| norm(&row[..3])).collect::<Vec<_>>());
        let force = mean(&rows.iter().map(|row| norm(&row[3..])).collect::<Vec<_>>());
        bins.push(Bin {
            span: [from, from + BIN_S],
            effort: effort.map_or(f64::NAN, |effort| mean(&effort[first..first + n])),
            still: turning < STILL_RATE.get() && (force - GRAVITY_M_S2).abs() < STILL_FORCE.get(),
            slides: slides[first + n / 2],
            means: std::array::from_fn(|k| rows.iter().map(|row| row[k]).sum::<f64>() / n as f64),
        });
        first += n;
    }
    bins
}

/// Whether nothing changes around a bin. What was not measured does not change.
fn rests(bins: &[Bin], i: usize) -> bool {
    let from = i.saturating_sub(NEIGHBOURS).min(bins.len().saturating_sub(2 * NEIGHBOURS));
    let around = &bins[from..bins.len().min(from + 2 * NEIGHBOURS)];
    let changes = |k: usize| {
        let middle = around.iter().map(|bin| bin.means[k]).sum::<f64>() / around.len() as f64;
        (around.iter().map(|bin| (bin.means[k] - middle).powi(2)).sum::<f64>() / around.len() as f64).sqrt()
    };
    let limit = |k: usize| if k < 3 { REST_RATE.get() } else { REST_FORCE.get() };
    let known = around.iter().any(|bin| bin.means.iter().any(|x| x.is_finite()));
    known && around.len() > NEIGHBOURS && !(0..6).any(|k| changes(k) > limit(k))
}
