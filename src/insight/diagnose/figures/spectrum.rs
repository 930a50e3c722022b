//! Power density of a residual (Welch): segments that overlap by half, each less its mean and under a Hann window.

use super::windows::UnbrokenRows;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Longest and shortest segment, rows; and as many as there should be at least.
const LONGEST: usize = 512;
const SHORTEST: usize = 16;
const SEGMENTS: usize = 12;
/// Runs whose period differs by more than this share from the usual are left out.
const SAME: f64 = 0.05;

/// One-sided power densities by frequency, Hz, without 0 Hz.
pub struct Spectra {
    pub hz: Vec<f64>,
    /// In squares of the channel's unit per Hz.
    pub before: Vec<f64>,
    pub after: Vec<f64>,
}

/// Both residuals of a channel; none where no run is long enough.
pub fn spectra(runs: &[UnbrokenRows], residuals: [&[f64]; 2]) -> Option<Spectra> {
    let period = runs.iter().max_by_key(|run| run.rows.len())?.period;
    let same = |run: &&UnbrokenRows| (run.period / period - 1.0).abs() < SAME;
    let pieces =
        |r: &'_ [f64]| -> Vec<Vec<f64>> { runs.iter().filter(same).map(|run| r[run.rows.clone()].to_vec()).collect() };
    let (before, after) = (pieces(residuals[0]), pieces(residuals[1]));
    let count = |n: usize| before.iter().map(|piece| (2 * piece.len() / n).saturating_sub(1)).sum::<usize>();
    let mut n = LONGEST;
    while n > SHORTEST && count(n) < SEGMENTS {
        n /= 2;
    }
    if count(n) == 0 {
        return None;
    }
    let hz = (1..=n / 2).map(|k| k as f64 / (n as f64 * period)).collect();
    Some(Spectra { hz, before: density(&before, n, period), after: density(&after, n, period) })
}

/// Power density at frequencies 1 to n / 2 times 1 / (n period).
fn density(pieces: &[Vec<f64>], n: usize, period: f64) -> Vec<f64> {
    let fft = FftPlanner::new().plan_fft_forward(n);
    let window: Vec<f64> = (0..n).map(|i| 0.5 - 0.5 * (TAU * i as f64 / n as f64).cos()).collect();
    let power: f64 = window.iter().map(|w| w * w).sum();
    let mut sum = vec![0.0; n / 2];
    let mut segments = 0.0;
    for piece in pieces {
        for from in (0..=piece.len().saturating_sub(n)).step_by(n / 2).filter(|from| from + n <= piece.len()) {
            let segment = &piece[from..from + n];
            let mean = segment.iter().sum::<f64>() / n as f64;
            let mut x: Vec<_> = segment.iter().zip(&window).map(|(x, w)| Complex::new((x - mean) * w, 0.0)).collect();
            fft.process(&mut x);
            for (k, sum) in sum.iter_mut().enumerate() {
                // Negative frequencies are counted with the positive ones; the highest is both.
                let sides = if k + 1 == n / 2 { 1.0 } else { 2.0 };
                *sum += sides * x[k + 1].norm_sqr() * period / power;
            }
            segments += 1.0;
        }
    }
    sum.into_iter().map(|s| s / segments).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers between -0.5 and 0.5 without order.
    fn noise(n: usize) -> Vec<f64> {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        (0..n).map(|_| next()).collect()
    }

    #[test]
    fn white_noise_is_flat_and_has_its_variance() {
        let d = density(&[noise(40_000), noise(25_000)[5_000..].to_vec()], 256, 0.01);
        let total: f64 = d.iter().sum::<f64>() / 2.56;
        assert!((total * 12.0 - 1.0).abs() < 0.03, "{total}");
        let level = 2.0 * 0.01 / 12.0;
        assert!(d[..127].iter().all(|d| (d / level - 1.0).abs() < 0.35));
    }

    #[test]
    fn a_tone_is_where_it_is_with_its_power() {
        let tone: Vec<f64> = (0..8192).map(|i| 3.0 * (TAU * 12.5 * i as f64 * 0.01).sin() + 7.0).collect();
        let whole = UnbrokenRows { rows: 0..8192, period: 0.01 };
        let s = spectra(&[whole], [&tone, &vec![0.0; 8192]]).unwrap();
        let top = (0..s.hz.len()).max_by(|a, b| s.before[*a].total_cmp(&s.before[*b])).unwrap();
        assert!((s.hz[top] - 12.5).abs() < 0.1);
        let total: f64 = s.before.iter().sum::<f64>() * s.hz[0];
        assert!((total - 4.5).abs() < 0.01, "{total}");
        assert!(s.after.iter().all(|p| *p == 0.0));
    }
}
