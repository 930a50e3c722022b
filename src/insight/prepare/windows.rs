//! Stretches of time over which the IMU is integrated and held against the odometry.

use crate::flight::Stream;
use crate::flight::series::period;
use crate::insight::criteria::usable::ODOMETRY_RATE_HZ;

/// Whether the odometry comes often enough.
pub fn often_enough(odometry: &Stream<10>) -> bool {
    !odometry.is_empty() && 1.0 / period(&odometry.time_s) >= ODOMETRY_RATE_HZ.get()
}

/// First and last sample of stretches of `over_s` seconds, one after the other, of which `good` holds.
pub fn windows(time: &[f64], over_s: f64, good: impl Fn([usize; 2]) -> bool) -> Vec<[usize; 2]> {
    let mut out = Vec::new();
    let mut from = 0;
    while from < time.len() {
        let to = time.partition_point(|&t| t < time[from] + over_s);
        if to >= time.len() {
            break;
        }
        if good([from, to]) {
            out.push([from, to]);
        }
        from = to;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_touch_and_end_in_time() {
        let time: Vec<f64> = (0..11).map(|i| 0.125 * f64::from(i)).collect();
        assert_eq!(windows(&time, 0.5, |_| true), [[0, 4], [4, 8]]);
        assert_eq!(windows(&time, 0.5, |[from, _]| from > 0), [[4, 8]]);
    }
}
