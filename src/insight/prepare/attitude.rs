//! The odometry's attitude at other times.

use crate::flight::Stream;
use crate::flight::series::interpolated;
use crate::model::attitude::Quaternion;

/// Attitudes are not interpolated across more than this, s.
const REACH_S: f64 = 0.1;
/// Between quaternions so far apart that their mean is this short leads no line.
const SHORTEST: f64 = 0.5;

/// Attitude at `times`, body to world; NaN where the odometry does not know it.
pub fn attitude(odometry: &Stream<10>, times: &[f64]) -> Vec<Quaternion<f64>> {
    let signs = signs(odometry);
    let part = |k: usize| {
        let column: Vec<f64> = odometry.rows.iter().zip(&signs).map(|(row, sign)| sign * row[3 + k]).collect();
        interpolated(&odometry.time_s, &column, times, REACH_S)
    };
    let q: [Vec<f64>; 4] = std::array::from_fn(part);
    (0..times.len()).map(|i| unit([q[0][i], q[1][i], q[2][i], q[3][i]])).collect()
}

/// Signs that make each quaternion a neighbour of the one before: a quaternion and its negative are the same attitude.
fn signs(odometry: &Stream<10>) -> Vec<f64> {
    let mut sign = 1.0;
    let mut before: Option<[f64; 4]> = None;
    let mut out = Vec::with_capacity(odometry.len());
    for row in &odometry.rows {
        let q = [row[3], row[4], row[5], row[6]];
        let along = before.map_or(0.0, |b| (0..4).map(|i| q[i] * b[i]).sum());
        if along < 0.0 {
            sign = -sign;
        }
        if q.iter().all(|x| x.is_finite()) {
            before = Some(q);
        }
        out.push(sign);
    }
    out
}

fn unit(q: Quaternion<f64>) -> Quaternion<f64> {
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    if norm > SHORTEST { q.map(|x| x / norm) } else { [f64::NAN; 4] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_that_jumps_is_no_turn() {
        let mut odometry = Stream::<10>::default();
        let mut row = [0.0; 10];
        for (i, w) in [1.0, -1.0, 1.0].into_iter().enumerate() {
            row[3] = w;
            odometry.push(0.05 * i as f64, row);
        }
        let found = attitude(&odometry, &[0.025, 0.1, 0.2]);
        assert_eq!(found[..2], [[1.0, 0.0, 0.0, 0.0]; 2]);
        assert!(found[2][0].is_nan());
    }
}
