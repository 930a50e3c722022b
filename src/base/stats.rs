//! Statistics of samples.

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

/// 97.5 % quantile of the standard normal distribution: half the width of a 95 % interval, in standard deviations.
pub const NORMAL_95: f64 = 1.959_964;

/// Mean; 0 for no sample.
pub fn mean(x: &[f64]) -> f64 {
    if x.is_empty() { 0.0 } else { x.iter().sum::<f64>() / x.len() as f64 }
}

/// The `q` quantile, 0..1, by linear interpolation between order statistics; NaN for no sample.
pub fn quantile(x: &[f64], q: f64) -> f64 {
    let mut sorted = x.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = q.clamp(0.0, 1.0) * last as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    low + (high - low) * at.fract()
}

/// Median; NaN for no sample. Of an even number of samples, the upper of the middle two.
pub fn median(x: &[f64]) -> f64 {
    let mut x = x.to_vec();
    let middle = x.len() / 2;
    if x.is_empty() { f64::NAN } else { *x.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// Standard deviation, of n samples with n - 1 degrees of freedom; `None` for fewer than two.
pub fn sd(x: &[f64]) -> Option<f64> {
    let middle = mean(x);
    let squares: f64 = x.iter().map(|x| (x - middle).powi(2)).sum();
    (x.len() > 1).then(|| (squares / (x.len() - 1) as f64).sqrt())
}

/// Half the width of the `confidence` interval of the mean of normal samples (Student's t); `None` for fewer than two.
pub fn mean_half_width(x: &[f64], confidence: f64) -> Option<f64> {
    let sd = sd(x)?;
    let t = StudentsT::new(0.0, 1.0, (x.len() - 1) as f64).ok()?.inverse_cdf(0.5 + 0.5 * confidence);
    Some(t * sd / (x.len() as f64).sqrt())
}

/// Chance that `n` independent squares of standard normal numbers sum to `sum` or more; 1 where there is none.
pub fn chi_squared_chance(sum: f64, n: usize) -> f64 {
    ChiSquared::new(n as f64).map_or(1.0, |distribution| distribution.sf(sum))
}

/// Standard deviation of normal samples, from the median of their distances to zero: outliers hardly move it.
pub fn robust_sd(centred: &[f64]) -> f64 {
    1.4826 * median(&centred.iter().map(|x| x.abs()).collect::<Vec<_>>())
}

/// Correlation coefficient; 0 where one of them does not vary.
pub fn correlation(x: &[f64], y: &[f64]) -> f64 {
    let (mx, my) = (mean(x), mean(y));
    let sum = |f: &dyn Fn(f64, f64) -> f64| x.iter().zip(y).map(|(x, y)| f(x - mx, y - my)).sum::<f64>();
    let (xy, xx, yy) = (sum(&|x, y| x * y), sum(&|x, _| x * x), sum(&|_, y| y * y));
    if xx > 0.0 && yy > 0.0 { xy / (xx * yy).sqrt() } else { 0.0 }
}

/// How well something measured was predicted.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Score {
    /// Root of the mean squared error.
    pub rmse: f64,
    /// Mean absolute error.
    pub mae: f64,
    /// Share of the variance that the prediction explains: 1 - sum(error^2) / sum((measured - mean)^2).
    pub r2: f64,
    pub n: usize,
}

impl Score {
    pub fn of(measured: &[f64], predicted: &[f64]) -> Self {
        let middle = mean(measured);
        let errors: Vec<f64> = measured.iter().zip(predicted).map(|(m, p)| m - p).collect();
        let squares = mean(&errors.iter().map(|e| e * e).collect::<Vec<_>>());
        let variance = mean(&measured.iter().map(|m| (m - middle).powi(2)).collect::<Vec<_>>());
        let mae = mean(&errors.iter().map(|e| e.abs()).collect::<Vec<_>>());
        Score { rmse: squares.sqrt(), mae, r2: 1.0 - squares / variance, n: errors.len() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate() {
        let x = [4.0, 1.0, 3.0, 2.0];
        assert_eq!([0.0, 0.5, 1.0].map(|q| quantile(&x, q)), [1.0, 2.5, 4.0]);
        assert!((quantile(&x, 0.05) - 1.15).abs() < 1e-12);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn intervals_by_hand() {
        assert_eq!(sd(&[1.0, 2.0, 3.0]), Some(1.0));
        assert_eq!((sd(&[1.0]), mean_half_width(&[1.0], 0.95)), (None, None));
        // t of 2 degrees of freedom is 4.3027 at 97.5 %.
        assert!((mean_half_width(&[1.0, 2.0, 3.0], 0.95).unwrap() - 4.3027 / 3f64.sqrt()).abs() < 1e-4);
    }

    #[test]
    fn scores_by_hand() {
        // Errors 1, -1, 0, 0; the measured values lie 3, 1, 1, 3 from their mean.
        let score = Score::of(&[1.0, 3.0, 5.0, 7.0], &[0.0, 4.0, 5.0, 7.0]);
        assert_eq!(score, Score { rmse: 0.5f64.sqrt(), mae: 0.5, r2: 1.0 - 2.0 / 20.0, n: 4 });
        assert_eq!(correlation(&[1.0, 2.0, 3.0], &[5.0, 3.0, 1.0]), -1.0);
        assert_eq!(correlation(&[1.0, 2.0], &[5.0, 5.0]), 0.0);
        assert!((robust_sd(&[-1.0, 1.0, 1.0, -1.0, 100.0]) - 1.4826).abs() < 1e-12);
    }
}
