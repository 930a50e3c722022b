//! Whether odometry and IMU share a clock: rotations seen by both must happen at the same time.

use super::{LogFinding, Severity};
use crate::base::stats::median;
use crate::flight::series::interpolated;
use crate::flight::{Log, Stream};
use crate::insight::criteria::consistent::{OFFSET_LEFT_S, OFFSET_MINIMUM, OFFSET_TURN_RAD, OFFSET_TURNS};
use crate::model::attitude::{Quaternion, compose, rotation_vector};

/// Offsets looked for, s.
const RANGE_S: f64 = 0.15;
const STEP_S: f64 = 0.002;
/// A rotation is taken over at least this time, so that noise of the attitude matters little, s.
const OVER_S: f64 = 0.02;

/// Rotation vectors between attitudes and the times at which they begin and end.
pub struct Turns {
    pub spans: Vec<[f64; 2]>,
    /// Body frame, rad.
    pub measured: Vec<[f64; 3]>,
}

/// The rotations that the odometry saw, where it saw attitudes.
pub fn turns(odometry: &Stream<10>) -> Turns {
    let mut out = Turns { spans: Vec::new(), measured: Vec::new() };
    let attitude = |i: usize| -> Quaternion<f64> { std::array::from_fn(|k| odometry.rows[i][3 + k]) };
    let mut from = 0;
    for to in 1..odometry.len() {
        let span = [odometry.time_s[from], odometry.time_s[to]];
        if span[1] - span[0] < OVER_S {
            continue;
        }
        let (a, b) = (attitude(from), attitude(to));
        from = to;
        let turn = compose([a[0], -a[1], -a[2], -a[3]], b);
        // An attitude that was not measured is no number, and makes none.
        if turn.iter().all(|x| x.is_finite()) && span[1] - span[0] < 10.0 * OVER_S {
            out.spans.push(span);
            out.measured.push(rotation_vector(turn));
        }
    }
    out
}

/// The integral of each body rate up to each IMU sample, rad.
pub fn integrals(imu: &Stream<6>) -> [Vec<f64>; 3] {
    std::array::from_fn(|k| {
        let mut sum = 0.0;
        let mut out = vec![0.0];
        for (pair, rows) in imu.time_s.windows(2).zip(imu.rows.windows(2)) {
            let step = 0.5 * (rows[0][k] + rows[1][k]) * (pair[1] - pair[0]);
            sum += if step.is_finite() { step } else { 0.0 };
            out.push(sum);
        }
        out
    })
}

/// What the gyro integrates to over each span, moved by `offset` seconds.
pub fn integrated(imu: &Stream<6>, integral: &[f64], spans: &[[f64; 2]], offset: f64) -> Vec<f64> {
    let at = |k: usize| -> Vec<f64> {
        let times: Vec<f64> = spans.iter().map(|span| span[k] + offset).collect();
        interpolated(&imu.time_s, integral, &times, f64::INFINITY)
    };
    at(1).iter().zip(at(0)).map(|(to, from)| to - from).collect()
}

/// Median distance between the turns and the gyro's; NaN without overlap.
fn mismatch(imu: &Stream<6>, integrals: &[Vec<f64>; 3], turns: &Turns, offset: f64) -> f64 {
    let gyro: [Vec<f64>; 3] = std::array::from_fn(|k| integrated(imu, &integrals[k], &turns.spans, offset));
    let squares: Vec<f64> = (0..turns.spans.len())
        .map(|i| (0..3).map(|k| (gyro[k][i] - turns.measured[i][k]).powi(2)).sum::<f64>())
        .filter(|x| x.is_finite())
        .collect();
    // The mean of squares without the outliers.
    let cap = 25.0 * median(&squares);
    crate::base::stats::mean(&squares.iter().map(|x| x.min(cap)).collect::<Vec<_>>())
}

/// Moves the odometry's clock to the IMU's where both saw the same turns at different times; by how much, s.
pub fn align(log: &mut Log, findings: &mut Vec<LogFinding>) -> f64 {
    let mut turns = turns(&log.odometry);
    let size = |turn: &[f64; 3]| turn.iter().map(|x| x * x).sum::<f64>().sqrt();
    let telling: Vec<bool> = turns.measured.iter().map(|turn| size(turn) > OFFSET_TURN_RAD.get()).collect();
    let mut keep = telling.iter();
    turns.spans.retain(|_| *keep.next().unwrap_or(&false));
    let mut keep = telling.iter();
    turns.measured.retain(|_| *keep.next().unwrap_or(&false));
    if turns.spans.len() < OFFSET_TURNS.count() {
        return 0.0;
    }
    let integrals = integrals(&log.imu);
    let steps = (RANGE_S / STEP_S) as i32;
    let costs: Vec<f64> =
        (-steps..=steps).map(|i| mismatch(&log.imu, &integrals, &turns, f64::from(i) * STEP_S)).collect();
    let best = (0..costs.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0);
    if best == 0 || best + 1 == costs.len() || costs[best] > OFFSET_MINIMUM.get() * median(&costs) {
        // No clear minimum: the signs are judged elsewhere.
        return 0.0;
    }
    let (a, b, c) = (costs[best - 1], costs[best], costs[best + 1]);
    let vertex = 0.5 * (a - c) / (a - 2.0 * b + c);
    let offset = (best as f64 - f64::from(steps) + vertex) * STEP_S;
    if offset.abs() < OFFSET_LEFT_S.get() {
        return 0.0;
    }
    let what = format!(
        "its turns come {:.1} ms {} the gyro's",
        1e3 * offset.abs(),
        if offset < 0.0 { "after" } else { "before" }
    );
    let so = "the odometry's clock is moved to the IMU's";
    findings.push(LogFinding::new(Severity::Warning, "clock_offset", "odometry", what, so));
    log.odometry.time_s.iter_mut().for_each(|t| *t += offset);
    offset
}
