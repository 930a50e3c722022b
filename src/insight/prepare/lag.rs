//! What a held command has become behind the response of what follows it.

use super::kept_steps::KeptSteps;
use crate::base::lane::fused;
use crate::model::dynamics::response::{ResponseSteps, limited, toward};

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

/// The response and its slope `dt` seconds later, toward `to`.
#[inline(always)]
fn after(steps: &mut KeptSteps<1>, by: Following, [y, slope]: [f64; 2], to: f64, dt: f64) -> [f64; 2] {
    let Following { tau, slew, inertia, .. } = by;
    if inertia > 0.0 {
        return steps.second_order(0, tau, inertia, dt).after(y, slope, to).into();
    }
    let mut left = || steps.left(0, tau, dt);
    [if slew > 0.0 { limited(y, to, tau, slew, dt, left) } else { toward(y, to, 1.0 - left()) }, 0.0]
}

/// `values`, each given at its of the ascending `times` and held until the next, as `by` follows them, at each of `at`.
/// The response is integrated exactly. Values that are not finite are skipped; NaN before the first.
pub fn followed(times: &[f64], values: &[f64], at: &[f64], by: Following) -> Vec<f64> {
    // Elsewhere a fused multiply-add is a call.
    fused(
        #[inline(always)]
        || follow(times, values, at, by),
    )
}

#[inline(always)]
fn follow(times: &[f64], values: &[f64], at: &[f64], by: Following) -> Vec<f64> {
    let known: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_finite()).collect();
    let Some(&first) = known.first() else { return vec![f64::NAN; at.len()] };
    let (mut now, mut y) = (0, [values[first], 0.0]);
    let mut steps = KeptSteps::default();
    let one = |t: &f64| {
        let t = t - by.delay;
        if t < times[first] {
            return f64::NAN;
        }
        while known.get(now + 1).is_some_and(|&next| times[next] <= t) {
            let i = known[now];
            y = after(&mut steps, by, y, values[i], times[known[now + 1]] - times[i]);
            now += 1;
        }
        let i = known[now];
        after(&mut steps, by, y, values[i], t - times[i])[0]
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
