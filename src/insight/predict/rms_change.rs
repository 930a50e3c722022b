//! By which share one vehicle's error differs from another's on the same flight, and how surely.

use crate::base::stats::mean_half_width;
use std::collections::BTreeMap;

/// Length of the stretches of flight whose errors are taken as independent of each other, s.
const STRETCH_S: f64 = 2.0;

/// By which share an RMS differs from another: 0.1 is a tenth more.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct RmsChange {
    pub by: f64,
    /// Ends of its 95 % interval, from how stretches of flight differ.
    pub low: f64,
    pub high: f64,
}

impl RmsChange {
    /// Of the squares `after` against those `before`, sums by stretch, by the delta method (Cochran, "Sampling
    /// Techniques", 1977, on ratios); `None` where there are fewer than two stretches, or one of both has no error.
    pub fn of(before: &[f64], after: &[f64]) -> Option<Self> {
        let [sum_before, sum_after] = [before, after].map(|squares| squares.iter().sum::<f64>());
        if sum_before <= 0.0 || sum_after <= 0.0 {
            return None;
        }
        // The logarithm of the ratio of the sums is pulled by each stretch by the difference of its shares.
        let n = before.len() as f64;
        let pulls: Vec<f64> = before.iter().zip(after).map(|(b, a)| n * (a / sum_after - b / sum_before)).collect();
        let half = 0.5 * mean_half_width(&pulls, 0.95)?;
        let log = 0.5 * (sum_after / sum_before).ln();
        let [by, low, high] = [log, log - half, log + half].map(f64::exp_m1);
        Some(Self { by, low, high })
    }
}

/// Sums of `squares` by stretch of each flight: of samples in the order of time, the number of their flight and their
/// times, s.
pub fn by_stretch(flight: &[usize], time_s: &[f64], squares: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sums: BTreeMap<(usize, i64), f64> = BTreeMap::new();
    for ((flight, time), square) in flight.iter().zip(time_s).zip(squares) {
        *sums.entry((*flight, (time / STRETCH_S).floor() as i64)).or_default() += square;
    }
    sums.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};

    #[test]
    fn what_every_stretch_shows_is_sure_and_what_one_shows_is_not() {
        let before = [1.0, 2.0, 1.0, 3.0];
        let all = RmsChange::of(&before, &before.map(|b| 1.21 * b)).unwrap();
        assert!([all.by, all.low, all.high].iter().all(|x| (x - 0.1).abs() < 1e-12), "{all:?}");
        let once = RmsChange::of(&before, &[1.0, 2.0, 1.0, 9.0]).unwrap();
        assert!(once.by > 0.3 && once.low < 0.0, "{once:?}");
        assert_eq!((RmsChange::of(&[1.0], &[2.0]), RmsChange::of(&[0.0; 2], &[1.0; 2])), (None, None));
    }

    #[test]
    fn the_interval_holds_the_truth_nineteen_times_in_twenty() {
        let mut random = Philox::new(1).sequence(RngStream::Bootstrap, 0, 0);
        let mut square = |scale: f64| scale * (0..4).map(|_| random.uniform([-0.5, 0.5]).powi(2)).sum::<f64>();
        let holds = (0..2000).filter(|_| {
            let [before, after] = [1.0, 1.44].map(|scale| (0..30).map(|_| square(scale)).collect::<Vec<f64>>());
            RmsChange::of(&before, &after).is_some_and(|change| change.low < 0.2 && 0.2 < change.high)
        });
        let share = holds.count() as f64 / 2000.0;
        assert!((0.93..0.97).contains(&share), "{share}");
    }

    #[test]
    fn stretches_are_of_one_flight_each() {
        let sums = by_stretch(&[0, 0, 0, 1], &[0.5, 1.9, 2.1, 0.5], [1.0, 2.0, 4.0, 8.0].into_iter());
        assert_eq!(sums, [3.0, 4.0, 8.0]);
    }
}
