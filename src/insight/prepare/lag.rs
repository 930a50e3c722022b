//! What a held command has become behind a first-order lag.

use crate::model::dynamics::response::{alpha, toward};

/// `values`, each given at its of the ascending `times` and held until the next, behind a first-order lag of `tau`
/// seconds, at each of `at` less `delay`. The lag is integrated exactly. Values that are not finite are skipped; NaN
/// before the first.
pub fn lagged(times: &[f64], values: &[f64], at: &[f64], tau: f64, delay: f64) -> Vec<f64> {
    let known: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_finite()).collect();
    let Some(&first) = known.first() else { return vec![f64::NAN; at.len()] };
    let (mut now, mut y) = (0, values[first]);
    // Nearly all steps are of one length.
    let mut last = (f64::NAN, 0.0);
    let mut share = |dt: f64| {
        if last.0 != dt {
            last = (dt, alpha(tau, dt));
        }
        last.1
    };
    let one = |t: &f64| {
        let t = t - delay;
        if t < times[first] {
            return f64::NAN;
        }
        while known.get(now + 1).is_some_and(|&next| times[next] <= t) {
            let i = known[now];
            y = toward(y, values[i], share(times[known[now + 1]] - times[i]));
            now += 1;
        }
        let i = known[now];
        toward(y, values[i], alpha(tau, t - times[i]))
    };
    at.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_followed_exactly() {
        let found = lagged(&[0.0, 1.0], &[0.0, 2.0], &[-0.1, 0.5, 1.0, 1.1], 0.1, 0.0);
        assert!(found[0].is_nan());
        assert_eq!(found[1..3], [0.0, 0.0]);
        assert!((found[3] - 2.0 * (1.0 - (-1.0f64).exp())).abs() < 1e-12, "{found:?}");
        assert!((lagged(&[0.0, 1.0], &[0.0, 2.0], &[1.2], 0.1, 0.1)[0] - found[3]).abs() < 1e-12);
    }
}
