//! Whether axes, signs and frames make sense together.

use super::offset::{integrals, integrated, turns};
use super::{LogFinding, Severity};
use crate::base::stats::{correlation, mean, median, quantile, sd};
use crate::flight::Log;
use crate::flight::series::{held, period};
use crate::flight::spans::{Span, contain};
use crate::insight::criteria::consistent::{
    ATTITUDE_CORRELATION, ATTITUDE_SHARE, ATTITUDE_TURN_RAD, FRAME_SAMPLES, GRAVITY_SHARE, SIGN_CORRELATION,
    SWAPPED_CORRELATION, SWAPPED_OWN, UPRIGHT_SHARE, VELOCITY_CORRELATION, VELOCITY_SAMPLES, VELOCITY_SPEED_M_S,
};
use crate::insight::criteria::flown::RATE_SPREAD;
use crate::model::attitude::body_axes;
use crate::model::constants::GRAVITY_M_S2;
use crate::model::vehicle::AXES;

/// Delays at which rates are compared with their setpoints, s.
const DELAYS_S: [f64; 4] = [0.0, 0.02, 0.05, 0.1];

/// Adds what contradicts itself within the `usable` spans.
pub fn judge(log: &Log, usable: &[Span], findings: &mut Vec<LogFinding>) {
    let chosen: Vec<usize> = (0..log.imu.len()).filter(|&i| contain(usable, log.imu.time_s[i])).collect();
    if chosen.len() < FRAME_SAMPLES.count() {
        return;
    }
    setpoints(log, &chosen, findings);
    upright(log, &chosen, findings);
    attitude(log, usable, findings);
    gravity(log, &chosen, findings);
    velocity(log, usable, findings);
}

fn problem(kind: &'static str, stream: &'static str, what: String, so: &str, findings: &mut Vec<LogFinding>) {
    findings.push(LogFinding::new(Severity::Problem, kind, stream, what, so));
}

/// Rates follow the setpoints of their own axis, in the same direction.
fn setpoints(log: &Log, chosen: &[usize], findings: &mut Vec<LogFinding>) {
    let gyro: [Vec<f64>; 3] = std::array::from_fn(|k| chosen.iter().map(|&i| log.imu.rows[i][k]).collect());
    let times: Vec<f64> = chosen.iter().map(|&i| log.imu.time_s[i]).collect();
    for axis in 0..3 {
        let setpoint = log.setpoint.column(axis);
        // What hardly moves even at its most goes with anything; manoeuvres may be few.
        let sent: Vec<f64> =
            held(&log.setpoint.time_s, &setpoint, &times).into_iter().filter(|x| x.is_finite()).collect();
        if quantile(&sent, 0.995) - quantile(&sent, 0.005) < RATE_SPREAD.get() {
            continue;
        }
        let agreement = |response: &[f64]| {
            let at = |delay: f64| {
                let earlier: Vec<f64> = times.iter().map(|t| t - delay).collect();
                let asked = held(&log.setpoint.time_s, &setpoint, &earlier);
                let (x, y): (Vec<f64>, Vec<f64>) =
                    asked.iter().zip(response).filter(|(x, y)| x.is_finite() && y.is_finite()).unzip();
                correlation(&x, &y)
            };
            DELAYS_S.map(at).into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
        };
        let own = agreement(&gyro[axis]);
        let other = (0..3).filter(|&k| k != axis).map(|k| (k, agreement(&gyro[k])));
        let (rival, most) = other.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap_or((axis, 0.0));
        let so = "give the sign or the axis in a mapping";
        if own < -SIGN_CORRELATION.get() {
            let what = format!("the {} rate goes against its setpoint (correlation {own:.2})", AXES[axis]);
            problem("sign", "setpoint", what, so, findings);
        } else if most.abs() > SWAPPED_CORRELATION.get() && own.abs() < SWAPPED_OWN.get() * most.abs() {
            let what = format!("the {} setpoint moves the {} rate (correlation {most:.2})", AXES[axis], AXES[rival]);
            problem("swapped_axes", "setpoint", what, so, findings);
        }
    }
}

/// In flight the thrust points along +z.
fn upright(log: &Log, chosen: &[usize], findings: &mut Vec<LogFinding>) {
    let middle: [f64; 3] =
        std::array::from_fn(|k| median(&chosen.iter().map(|&i| log.imu.rows[i][3 + k]).collect::<Vec<_>>()));
    let so = "turn the IMU in a mapping (`rotation_deg`, or body = \"FRD\")";
    if middle[2] < 0.0 && middle[2].abs() > middle[0].abs().max(middle[1].abs()) {
        let what = format!("the specific force along z is {:.1} m/s2 at the median: z points down", middle[2]);
        problem("frame", "imu", what, so, findings);
    } else if middle[0].abs().max(middle[1].abs()) > UPRIGHT_SHARE.get() * middle[2].abs() {
        let [x, y, z] = middle;
        let what = format!("specific force at the median is ({x:.1}, {y:.1}, {z:.1}) m/s2, not along z");
        problem("frame", "imu", what, so, findings);
    }
}

/// The attitude turns as the gyro says.
fn attitude(log: &Log, usable: &[Span], findings: &mut Vec<LogFinding>) {
    let turns = turns(&log.odometry);
    let integrals = integrals(&log.imu);
    for (k, axis) in AXES.into_iter().enumerate() {
        let gyro = integrated(&log.imu, &integrals[k], &turns.spans, 0.0);
        let (x, y): (Vec<f64>, Vec<f64>) = (0..turns.spans.len())
            .filter(|&i| gyro[i].is_finite() && contain(usable, turns.spans[i][0]))
            .map(|i| (turns.measured[i][k], gyro[i]))
            .unzip();
        let agreement = correlation(&x, &y);
        // Little turning tells nothing; a held or smoothed attitude still agrees in sign, and one with more noise than
        // turns has the gyro's on average.
        let turning = y.iter().map(|y| y.abs()).fold(0.0, f64::max) > ATTITUDE_TURN_RAD.get();
        let share = agreement * sd(&x).unwrap_or(0.0) / sd(&y).unwrap_or(0.0).max(1e-300);
        let wrong = agreement < ATTITUDE_CORRELATION.get() && share < ATTITUDE_SHARE.get();
        if x.len() > FRAME_SAMPLES.count() && turning && wrong {
            let what = format!("the attitude does not turn in {axis} as the gyro does (correlation {agreement:.2})");
            let so = "check the frames (FLU or FRD, ENU or NED) and the order of the quaternion in a mapping";
            problem("frame", "odometry", what, so, findings);
        }
    }
}

/// Specific force turned into the world carries the vehicle against gravity.
fn gravity(log: &Log, chosen: &[usize], findings: &mut Vec<LogFinding>) {
    let times: Vec<f64> = chosen.iter().map(|&i| log.imu.time_s[i]).collect();
    let q: [Vec<f64>; 4] = std::array::from_fn(|k| held(&log.odometry.time_s, &log.odometry.column(3 + k), &times));
    let lift: Vec<f64> = (0..chosen.len())
        .map(|j| {
            let axes = body_axes([q[0][j], q[1][j], q[2][j], q[3][j]]);
            (0..3).map(|k| axes[k][2] * log.imu.rows[chosen[j]][3 + k]).sum()
        })
        .filter(|x: &f64| x.is_finite())
        .collect();
    let carried = mean(&lift);
    if lift.len() > FRAME_SAMPLES.count() && (carried / GRAVITY_M_S2 - 1.0).abs() > GRAVITY_SHARE.get() {
        let what = format!(
            "specific force turned upright by the attitude is {carried:.1} m/s2 on average, not {GRAVITY_M_S2}"
        );
        problem("frame", "odometry", what, "check the attitude's frames, or the accelerometer's scale", findings);
    }
}

/// Means of every `n` values that follow each other.
fn mean_of(values: &[f64], n: usize) -> Vec<f64> {
    values.windows(n).map(mean).collect()
}

/// Velocity is the change of position.
fn velocity(log: &Log, usable: &[Span], findings: &mut Vec<LogFinding>) {
    let odometry = &log.odometry;
    let times = &odometry.time_s;
    if times.len() < 2 {
        return;
    }
    let stride = (0.1 / period(times)).ceil().max(1.0) as usize;
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let (mut from_position, mut measured) = (Vec::new(), Vec::new());
        for i in (stride..odometry.len()).step_by(stride) {
            let (a, b, middle) = (&odometry.rows[i - stride], &odometry.rows[i], &odometry.rows[i - stride / 2]);
            let axes = body_axes([middle[3], middle[4], middle[5], middle[6]]);
            let v: f64 = (0..3).map(|j| axes[j][k] * middle[7 + j]).sum();
            let d = (b[k] - a[k]) / (times[i] - times[i - stride]);
            if v.is_finite() && d.is_finite() && contain(usable, times[i]) {
                from_position.push(d);
                measured.push(v);
            }
        }
        // Over half a second, noise of the position matters little.
        let [from_position, measured] = [from_position, measured].map(|v| mean_of(&v, 5));
        let agreement = correlation(&from_position, &measured);
        let moving = measured.iter().map(|v| v.abs()).fold(0.0, f64::max) > VELOCITY_SPEED_M_S.get();
        if measured.len() > VELOCITY_SAMPLES.count() && moving && agreement < VELOCITY_CORRELATION.get() {
            let what =
                format!("the velocity along {axis} is not the change of the position (correlation {agreement:.2})");
            let so = "check the velocity's frame (body or world) and its signs in a mapping";
            problem("frame", "odometry", what, so, findings);
        }
    }
}
