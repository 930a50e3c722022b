//! What the tanh does to the entropy of an action, by quadrature.
//!
//! The entropy of a = tanh(z) is that of z plus E[ln(1 - a^2)] for each command. Without the second part a wide z is
//! rewarded for ever, although its actions have long become full stick to either side; with it the widest action is the
//! even one, at a standard deviation of z of about 0.9.

use crate::base::lane::Real;

/// Places and weights of the Gauss-Hermite rule of five nodes for a standard normal, but for its middle (Abramowitz and
/// Stegun, table 25.10, scaled): exact for polynomials up to degree nine.
const NODES: [(f64, f64); 4] = [
    (-2.856_970_013_872_805_8, 0.011_257_411_327_720_691),
    (-1.355_626_179_974_266, 0.222_075_922_005_612_64),
    (1.355_626_179_974_266, 0.222_075_922_005_612_64),
    (2.856_970_013_872_805_8, 0.011_257_411_327_720_691),
];
const MIDDLE: f64 = 0.533_333_333_333_333_3;

/// E[ln(1 - tanh^2 z)] of a normal z, and its derivatives by mean and logarithm of the standard deviation.
#[derive(Clone, Copy)]
pub struct Squash<R> {
    pub value: R,
    pub d_mean: R,
    pub d_log_std: R,
}

/// Of a z about `mean` with standard deviation `std`. Exact derivatives of the quadrature's value.
#[inline(always)]
pub fn squash<R: Real>(mean: R, std: R) -> Squash<R> {
    let (log, tanh) = log_slope(mean);
    let middle = R::of(MIDDLE);
    let (mut value, mut d_mean, mut d_log_std) = (middle * log, middle * tanh, R::zero());
    for (x, weight) in NODES {
        let offset = R::of(x) * std;
        let (log, tanh) = log_slope(mean + offset);
        let share = R::of(weight) * tanh;
        value = R::of(weight).mul_add(log, value);
        d_mean = d_mean + share;
        d_log_std = share.mul_add(offset, d_log_std);
    }
    let slope = R::of(-2.0);
    Squash { value, d_mean: slope * d_mean, d_log_std: slope * d_log_std }
}

/// ln(1 - tanh^2 z) = 2 (ln 2 - |z| - ln(1 + exp(-2 |z|))), which no z makes infinite, and tanh z from the same
/// exponential.
#[inline(always)]
fn log_slope<R: Real>(z: R) -> (R, R) {
    let size = z.abs();
    let e = (R::of(-2.0) * size).exp();
    let sum = R::one() + e;
    let tanh = (R::one() - e) / sum;
    let log = R::of(2.0) * (R::of(std::f64::consts::LN_2) - size - sum.ln());
    (log, R::select(z.lt(R::zero()), -tanh, tanh))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the midpoint rule over twelve standard deviations.
    fn integral(mean: f64, std: f64) -> f64 {
        const STEPS: usize = 48_000;
        let width = 24.0 / STEPS as f64;
        let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
        let term = |x: f64| density(x) * log_slope(mean + std * x).0;
        (0..STEPS).map(|i| width * term(-12.0 + (i as f64 + 0.5) * width)).sum()
    }

    #[test]
    fn the_quadrature_is_the_integral() {
        // Largest error allowed: what wide distributions lose is no more than a few percent of their own size.
        for (std, error) in [(0.1, 1e-6), (0.3, 2e-4), (0.6, 8e-3), (1.0, 0.04), (2.0, 0.4)] {
            for mean in [0.0, 0.4, -1.2, 3.0] {
                let (found, exact) = (squash(mean, std).value, integral(mean, std));
                assert!((found - exact).abs() < error, "mean {mean}, std {std}: {found} instead of {exact}");
            }
        }
    }

    #[test]
    fn nothing_is_infinite_and_the_widest_action_is_known() {
        for z in [-1e30f32, -80.0, 0.0, 1e-20, 44.0, 1e30] {
            let Squash { value, d_mean, d_log_std } = squash(z, 0.5f32);
            assert!(value.is_finite() && d_mean.is_finite() && d_log_std.is_finite(), "{z}");
        }
        // The entropy's derivative by log_std, 1 + that of the squash, changes sign once.
        let rises = |std: f64| 1.0 + squash(0.0, std).d_log_std > 0.0;
        assert!(rises(0.8) && !rises(1.0) && !rises(5.0) && !rises(50.0));
    }
}
