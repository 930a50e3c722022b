//! Zero-phase low-pass: a second-order Butterworth filter run forwards and backwards.

use std::f64::consts::{PI, SQRT_2};

/// Coefficients of one second-order section, by the bilinear transform.
#[derive(Clone, Copy, Debug)]
pub struct LowPass {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// Half power (after both passes) near `cutoff_hz` for samples `period_s` apart; `None` where the samples are too
    /// sparse for that to remove anything.
    pub fn new(cutoff_hz: f64, period_s: f64) -> Option<Self> {
        // Two passes halve the power 20 % below the corner of one.
        let corner = cutoff_hz / (SQRT_2 - 1.0).powf(0.25);
        if corner * period_s >= 0.45 {
            return None;
        }
        let w = (PI * corner * period_s).tan();
        let norm = 1.0 / (1.0 + SQRT_2 * w + w * w);
        let b0 = w * w * norm;
        Some(Self { b: [b0, 2.0 * b0, b0], a: [2.0 * (w * w - 1.0) * norm, (1.0 - SQRT_2 * w + w * w) * norm] })
    }

    /// Filters `x` in place; the ends continue as constants.
    pub fn run(&self, x: &mut [f64]) {
        self.pass(x.iter_mut());
        self.pass(x.iter_mut().rev());
    }

    fn pass<'a>(&self, x: impl Iterator<Item = &'a mut f64>) {
        let Self { b, a } = self;
        let mut state: Option<[f64; 2]> = None;
        for x in x {
            // At rest in the first sample: gain one, so the output is the input.
            let [s1, s2] = state.unwrap_or([*x * (1.0 - b[0]), *x * (b[2] - a[1])]);
            let y = b[0] * *x + s1;
            state = Some([b[1] * *x - a[0] * y + s2, b[2] * *x - a[1] * y]);
            *x = y;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Amplitude of a filtered sine of unit amplitude, and its phase against the original, from the middle of a long
    /// record.
    fn response(hz: f64) -> (f64, f64) {
        let (dt, n) = (0.001, 20_000);
        let phase = |i: usize| 2.0 * PI * hz * i as f64 * dt;
        let mut x: Vec<f64> = (0..n).map(|i| phase(i).sin()).collect();
        LowPass::new(30.0, dt).unwrap().run(&mut x);
        let middle = 5_000..15_000;
        let project =
            |f: fn(f64) -> f64| middle.clone().map(|i| x[i] * f(phase(i))).sum::<f64>() * 2.0 / middle.len() as f64;
        let (s, c) = (project(f64::sin), project(f64::cos));
        (s.hypot(c), c.atan2(s))
    }

    #[test]
    fn passes_below_halves_power_at_the_cutoff_stops_above_without_phase() {
        for (hz, low, high) in [(1.0, 0.999, 1.001), (30.0, 0.69, 0.73), (300.0, 0.0, 1e-3)] {
            let (amplitude, phase) = response(hz);
            assert!((low..high).contains(&amplitude), "{hz} Hz: {amplitude}");
            assert!(hz > 100.0 || phase.abs() < 1e-3, "{hz} Hz: {phase}");
        }
    }

    #[test]
    fn a_constant_stays() {
        let mut x = [3.0; 50];
        LowPass::new(20.0, 0.002).unwrap().run(&mut x);
        assert!(x.iter().all(|x| (x - 3.0).abs() < 1e-12));
        assert!(LowPass::new(60.0, 0.01).is_none());
    }
}
