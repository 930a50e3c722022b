//! Noise that remembers: each value predicted from those before it.

use nalgebra::{DMatrix, DVector};

/// What the past says of the present.
pub struct Autoregression {
    /// Coefficients, newest first.
    pub past: Vec<f64>,
    /// Mean square of the values.
    pub power: f64,
    /// Share of the power that the past predicts, 0..1, of the values that have one.
    pub predicted: f64,
}

/// Least squares of each value on the `order` before it. `follows(i)` tells whether value `i` comes right after the one
/// before; a value with a gap in its past is not fitted.
pub fn autoregression(x: &[f64], follows: impl Fn(usize) -> bool, order: usize) -> Autoregression {
    let mut normal = DMatrix::<f64>::zeros(order, order);
    let mut right = DVector::<f64>::zeros(order);
    let (mut run, mut squares, mut fitted) = (0, 0.0, 0.0);
    for i in 0..x.len() {
        run = if follows(i) { run + 1 } else { 0 };
        squares += x[i] * x[i];
        if run < order {
            continue;
        }
        fitted += x[i] * x[i];
        for a in 0..order {
            right[a] += x[i] * x[i - 1 - a];
            for b in 0..=a {
                normal[(a, b)] += x[i - 1 - a] * x[i - 1 - b];
            }
        }
    }
    // Values without noise would leave nothing to divide by.
    let ridge = 1e-6 * squares + 1e-300;
    let full = DMatrix::from_fn(order, order, |a, b| normal[(a.max(b), a.min(b))] + if a == b { ridge } else { 0.0 });
    let past = full.cholesky().map_or(DVector::zeros(order), |c| c.solve(&right));
    Autoregression {
        power: squares / x.len().max(1) as f64,
        predicted: (past.dot(&right) / f64::max(fitted, 1e-300)).clamp(0.0, 1.0),
        past: past.iter().copied().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};
    use rand::RngExt;
    use rand_distr::StandardNormal;

    #[test]
    fn memory_is_found_and_gaps_are_none() {
        let mut rng = Philox::new(3).sequence(RngStream::Noise, 0, 0);
        let mut x = vec![0.0; 20_000];
        for i in 1..x.len() {
            x[i] = 0.8 * x[i - 1] + 0.6 * rng.sample::<f64, _>(StandardNormal);
        }
        let found = autoregression(&x, |i| i > 0, 2);
        assert!((found.past[0] - 0.8).abs() < 0.03 && found.past[1].abs() < 0.03, "{:?}", found.past);
        assert!((found.power - 1.0).abs() < 0.06 && (found.predicted - 0.64).abs() < 0.03);
        assert_eq!(autoregression(&x, |_| false, 2).predicted, 0.0);
    }
}
