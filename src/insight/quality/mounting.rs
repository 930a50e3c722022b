//! How the IMU is turned, or mirrored, against the body, and the line of a mapping that mends it.

use super::offset::{integrals, integrated, turns};
use super::{LogFinding, Severity};
use crate::base::stats::median;
use crate::flight::Log;
use crate::flight::series::held;
use crate::flight::spans::{Span, contain};
use crate::insight::criteria::consistent::{
    ATTITUDE_TURN_RAD, FRAME_SAMPLES, MOUNTING_BETTER, MOUNTING_FIT, MOUNTING_RANK, MOUNTING_SEEN_RAD,
    MOUNTING_WRONG_RAD,
};
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Delays after which rates are compared with their setpoints, s.
const DELAYS_S: [f64; 4] = [0.0, 0.02, 0.05, 0.1];
/// Angles this near to a quarter turn are taken for one, deg.
const SNAP_DEG: f64 = 4.0;

/// Rates in the axes of the log, and the same turn in those of the body.
type Pairs = Vec<(Vector3<f64>, Vector3<f64>)>;

/// What turns one set of vectors into another.
struct MountingTurn {
    /// Orthogonal; of determinant -1 where the axes are mirrored.
    matrix: Matrix3<f64>,
    /// Share of the squares that it explains, and that no turn at all does.
    fit: f64,
    as_it_is: f64,
}

/// Adds what is known of the mounting, from flight within the `usable` spans.
pub fn find(log: &Log, usable: &[Span], findings: &mut Vec<LogFinding>) {
    let rows = log.imu.time_s.iter().zip(&log.imu.rows).filter(|(time, _)| contain(usable, **time));
    let force: [Vec<f64>; 3] = std::array::from_fn(|k| rows.clone().map(|(_, row)| row[3 + k]).collect());
    if force[0].len() < FRAME_SAMPLES.count() {
        return;
    }
    let up = Vector3::from(force.map(|x| median(&x)));
    let upright = up.z > up.x.abs().max(up.y.abs());
    if let Some(turn) = MountingTurn::of(&attitude(log, usable)) {
        findings.extend(turn.told(upright, "the attitude"));
    } else if !upright && up.iter().all(|x| x.is_finite()) {
        // Thrust, and with it the median of the specific force, is along the body's z axis.
        let mut pairs = setpoints(log, usable);
        let size = (pairs.iter().map(|(rate, _)| rate.norm_squared()).sum::<f64>()).sqrt();
        pairs.push((up.normalize() * size, Vector3::z() * size));
        findings.extend(MountingTurn::of(&pairs).and_then(|turn| turn.told(upright, "setpoints and thrust")));
    }
}

/// The turns that the attitude took.
fn attitude(log: &Log, usable: &[Span]) -> Pairs {
    let turns = turns(&log.odometry);
    let integrals = integrals(&log.imu);
    let gyro: [Vec<f64>; 3] = std::array::from_fn(|k| integrated(&log.imu, &integrals[k], &turns.spans, 0.0));
    let pair = |i: usize| (Vector3::from([gyro[0][i], gyro[1][i], gyro[2][i]]), Vector3::from(turns.measured[i]));
    (0..turns.spans.len()).filter(|&i| contain(usable, turns.spans[i][0])).map(pair).collect()
}

/// The rates that were asked for, at the delay at which they are most alike in size.
fn setpoints(log: &Log, usable: &[Span]) -> Pairs {
    let chosen: Vec<usize> = (0..log.imu.len()).filter(|&i| contain(usable, log.imu.time_s[i])).collect();
    let at = |delay: f64| -> Pairs {
        let times: Vec<f64> = chosen.iter().map(|&i| log.imu.time_s[i] - delay).collect();
        let asked: [Vec<f64>; 3] = std::array::from_fn(|k| held(&log.setpoint.time_s, &log.setpoint.column(k), &times));
        let gyro = |i: usize| Vector3::from(std::array::from_fn(|k| log.imu.rows[chosen[i]][k]));
        let pairs = (0..chosen.len()).map(|i| (gyro(i), Vector3::from([asked[0][i], asked[1][i], asked[2][i]])));
        pairs.filter(|(a, b)| a.iter().chain(b.iter()).all(|x| x.is_finite())).collect()
    };
    let fit = |pairs: &Pairs| MountingTurn::of(pairs).map_or(f64::NEG_INFINITY, |turn| turn.fit);
    DELAYS_S.map(at).into_iter().max_by(|a, b| fit(a).total_cmp(&fit(b))).unwrap_or_default()
}

impl MountingTurn {
    /// The best in least squares (Kabsch 1976); `None` where too little was turned to tell.
    fn of(pairs: &Pairs) -> Option<Self> {
        let finite = |(a, b): &&(Vector3<f64>, Vector3<f64>)| a.iter().chain(b.iter()).all(|x| x.is_finite());
        let pairs: Vec<_> = pairs.iter().filter(finite).collect();
        let most = pairs.iter().map(|(a, _)| a.norm()).fold(0.0, f64::max);
        if pairs.len() < FRAME_SAMPLES.count() || most < ATTITUDE_TURN_RAD.get() {
            return None;
        }
        let product: Matrix3<f64> = pairs.iter().map(|(a, b)| b * a.transpose()).sum();
        let svd = product.svd(true, true);
        let (u, v) = (svd.u?, svd.v_t?);
        let [largest, middle, least] = [svd.singular_values[0], svd.singular_values[1], svd.singular_values[2]];
        if middle < MOUNTING_RANK.get() * largest {
            return None;
        }
        // Two axes leave the handedness open: it is then taken for right.
        let mut sign = (u * v).determinant().signum();
        let mirrored = sign < 0.0 && least > MOUNTING_RANK.get() * largest;
        sign = if mirrored { 1.0 } else { sign };
        let matrix = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v;
        let squares: f64 = pairs.iter().map(|(_, b)| b.norm_squared()).sum();
        let fit = |matrix: &Matrix3<f64>| {
            1.0 - pairs.iter().map(|(a, b)| (b - matrix * a).norm_squared()).sum::<f64>() / squares
        };
        Some(Self { matrix, fit: fit(&matrix), as_it_is: fit(&Matrix3::identity()) })
    }

    /// What is wrong, if anything is.
    fn told(&self, upright: bool, against: &str) -> Option<LogFinding> {
        if self.fit < MOUNTING_FIT.get() || self.fit - self.as_it_is < MOUNTING_BETTER.get() * (1.0 - self.as_it_is) {
            return None;
        }
        let fit = 100.0 * self.fit;
        if self.matrix.determinant() < 0.0 {
            let what = format!("the gyro's axes are mirrored against {against}: {} ({fit:.0} % agrees)", self.axes());
            let so = "no rotation mends that: write the gyro's fields in a mapping in this order, with these signs";
            return Some(LogFinding::new(Severity::Problem, "mounting", "imu", what, so));
        }
        let rotation = Rotation3::from_matrix_unchecked(self.matrix);
        let angle = rotation.angle();
        if angle < MOUNTING_SEEN_RAD.get() {
            return None;
        }
        let severity = if angle > MOUNTING_WRONG_RAD.get() { Severity::Problem } else { Severity::Warning };
        let (roll, pitch, yaw) = rotation.euler_angles();
        let line = [roll, pitch, yaw].map(|angle| snapped(angle.to_degrees()));
        let line = format!("rotation_deg = [{}, {}, {}]", line[0], line[1], line[2]);
        let turned = format!("turned by {:.0} deg against", angle.to_degrees());
        // Where thrust is along z the IMU stands right, and the attitude is of other axes.
        if upright && self.matrix[(2, 2)] < std::f64::consts::FRAC_1_SQRT_2 {
            let what = format!("the attitude is of body axes {turned} the IMU's, which is upright ({fit:.0} % agrees)");
            let so = "give the odometry's `body` (FLU or FRD) and `world` (ENU or NED) in a mapping";
            return Some(LogFinding::new(severity, "mounting", "odometry", what, so));
        }
        let what = format!("the IMU is {turned} {against} ({fit:.0} % agrees)");
        let so = format!("below [imu] of a mapping that turns nothing yet, `{line}` mends it");
        Some(LogFinding::new(severity, "mounting", "imu", what, &so))
    }

    /// The axes of the log along each axis of the body, to the nearest.
    fn axes(&self) -> String {
        let along = |row: usize| {
            let size = |k: &usize| self.matrix[(row, *k)].abs();
            let k = (0..3).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(row);
            let sign = if self.matrix[(row, k)] < 0.0 { "-" } else { "" };
            format!("{} is {sign}{}", ["x", "y", "z"][row], ["x", "y", "z"][k])
        };
        [0, 1, 2].map(along).join(", ")
    }
}

/// In whole degrees, a quarter turn where it is near to one.
fn snapped(degrees: f64) -> f64 {
    let quarter = 90.0 * (degrees / 90.0).round();
    let near = if (degrees - quarter).abs() < SNAP_DEG { quarter } else { degrees.round() };
    // No minus before a zero.
    near + 0.0
}
