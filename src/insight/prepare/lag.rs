//! What a held command has become behind the response of what follows it.

use crate::model::dynamics::response::{alpha, limited, second_order, toward};

/// How a command is followed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Following {
    /// Time constant of the first-order lag, s.
    pub tau: f64,
    /// Time by which everything is later, s.
    pub delay: f64,
    /// One over the largest slope, s over the command's unit; 0 where there is none.
    pub slew: f64,
    /// T2 of T2 y'' + tau y' + y = command, s2; 0 where it is of first order. Beside it no slope is limited.
    pub inertia: f64,
}

impl Following {
    /// A first-order lag of `tau` seconds, and nothing else.
    pub fn lag(tau: f64) -> Self {
        Self { tau, ..Self::default() }
    }
}

/// `values`, each given at its of the ascending `times` and held until the next, as `by` follows them, at each of `at`.
/// The response is integrated exactly. Values that are not finite are skipped; NaN before the first.
pub fn followed(times: &[f64], values: &[f64], at: &[f64], by: Following) -> Vec<f64> {
    let Following { tau, delay, slew, inertia } = by;
    let known: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_finite()).collect();
    let Some(&first) = known.first() else { return vec![f64::NAN; at.len()] };
    let (mut now, mut y, mut slope) = (0, values[first], 0.0);
    // Nearly all steps are of one length.
    let mut last = (f64::NAN, 0.0);
    let mut after = |y: f64, slope: f64, to: f64, dt: f64| {
        if inertia > 0.0 {
            return second_order(y, slope, to, tau, inertia, dt);
        }
        if slew > 0.0 {
            return (limited(y, to, tau, slew, dt), 0.0);
        }
        if last.0 != dt {
            last = (dt, alpha(tau, dt));
        }
        (toward(y, to, last.1), 0.0)
    };
    let one = |t: &f64| {
        let t = t - delay;
        if t < times[first] {
            return f64::NAN;
        }
        while known.get(now + 1).is_some_and(|&next| times[next] <= t) {
            let i = known[now];
            (y, slope) = after(y, slope, values[i], times[known[now + 1]] - times[i]);
            now += 1;
        }
        let i = known[now];
        after(y, slope, values[i], t - times[i]).0
    };
    at.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_followed_exactly() {
        let by = Following::lag(0.1);
        let found = followed(&[0.0, 1.0], &[0.0, 2.0], &[-0.1, 0.5, 1.0, 1.1], by);
        assert!(found[0].is_nan());
        assert_eq!(found[1..3], [0.0, 0.0]);
        assert!((found[3] - 2.0 * (1.0 - (-1.0f64).exp())).abs() < 1e-12, "{found:?}");
        let late = Following { delay: 0.1, ..by };
        assert!((followed(&[0.0, 1.0], &[0.0, 2.0], &[1.2], late)[0] - found[3]).abs() < 1e-12);
        // At most 4 a second: 1.6 are straight, and of 0.4 more the lag leaves exp(-1) after its 0.1 s.
        let limited = followed(&[0.0, 1.0], &[0.0, 2.0], &[1.2, 1.5], Following { slew: 0.25, ..by });
        assert!((limited[0] - 0.8).abs() < 1e-12, "{limited:?}");
        assert!((limited[1] - (2.0 - 0.4 * (-1.0f64).exp())).abs() < 1e-12, "{limited:?}");
    }
}
