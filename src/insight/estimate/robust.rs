//! Weights and limits that outliers do not rule.

use crate::base::stats::robust_sd;

/// Huber's weight of a residual of `z` standard deviations: 1 up to `bound`, then so that its pull grows no more.
/// Huber, "Robust Estimation of a Location Parameter", Ann. Math. Statist. 35, 1964.
pub fn huber(z: f64, bound: f64) -> f64 {
    (bound / z.abs()).min(1.0)
}

/// `x` with everything beyond so many robust standard deviations of zero set to that limit; `least` is the least
/// standard deviation.
pub fn capped(x: &[f64], deviations: f64, least: f64) -> Vec<f64> {
    let cap = deviations * robust_sd(x).max(least);
    x.iter().map(|x| x.clamp(-cap, cap)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_far_pulls_no_more_than_what_is_at_the_bound() {
        assert_eq!([0.0, 2.9, -3.0].map(|z| huber(z, 3.0)), [1.0; 3]);
        assert_eq!(huber(-30.0, 3.0) * 30.0, 3.0);
        let x = [1.0, -1.0, 1.0, -1.0, 100.0];
        assert_eq!(capped(&x, 2.0, 0.0)[4], 2.0 * 1.4826);
    }
}
