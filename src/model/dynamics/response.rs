//! Response of the inner loop to commands: first order (paper Eq. 6), with a limit to its slope, and second order.

use crate::base::lane::{Mask, Real};

/// 1 - exp(-dt / tau): the share of the gap between command and response that closes in `dt` seconds.
pub fn alpha(tau: f64, dt: f64) -> f64 {
    -f64::exp_m1(-dt / tau)
}

/// `from` moved toward `to` by the share `alpha`.
#[inline(always)]
pub fn toward<R: Real>(from: R, to: R, alpha: R) -> R {
    alpha.mul_add(to - from, from)
}

/// Where what a step of time does to the response of an axis (roll, pitch, yaw, thrust) comes from: it does not depend
/// on where the response stands, and steps of the same length do the same.
pub trait ResponseSteps<R> {
    /// exp(-dt / tau): the share of a gap that is left.
    fn left(&mut self, axis: usize, tau: R, dt: R) -> R;
    /// See [`second_order`].
    fn second_order(&mut self, axis: usize, tau: R, inertia: R, dt: R) -> SecondOrder<R>;
}

/// Computed each time.
pub struct Computed;

impl<R: Real> ResponseSteps<R> for Computed {
    #[inline(always)]
    fn left(&mut self, _: usize, tau: R, dt: R) -> R {
        (-(dt / tau)).exp()
    }

    #[inline(always)]
    fn second_order(&mut self, _: usize, tau: R, inertia: R, dt: R) -> SecondOrder<R> {
        second_order(tau, inertia, dt)
    }
}

/// First order whose slope is at most one over `slew` (s), after `dt` seconds: straight while the gap is more than the
/// limit times `tau`, exponential afterwards; `left` is of a step without the limit.
#[inline(always)]
pub fn limited<R: Real>(from: R, to: R, tau: R, slew: R, dt: R, left: impl FnOnce() -> R) -> R {
    let slew = slew.max(R::of(1e-12));
    let gap = to - from;
    let straight = (gap.abs() * slew - tau).clamp(R::zero(), dt);
    if !R::zero().lt(straight).any() {
        return toward(from, to, R::one() - left());
    }
    let way = (straight / slew).min(gap.abs());
    let reached = from + R::select(gap.lt(R::zero()), -way, way);
    toward(reached, to, R::one() - (-((dt - straight) / tau)).exp())
}

/// What one step of time does to inertia x'' + tau x' + x = to, exactly.
#[derive(Clone, Copy, Debug)]
pub struct SecondOrder<R> {
    sigma: R,
    stiffness: R,
    even: R,
    odd: R,
}

impl<R: Real> SecondOrder<R> {
    /// x and x' after the step.
    #[inline(always)]
    pub fn after(self, x: R, slope: R, to: R) -> (R, R) {
        let Self { sigma, stiffness, even, odd } = self;
        let gap = x - to;
        let value = gap.mul_add(sigma.mul_add(odd, even), slope * odd);
        let change = slope.mul_add(even - sigma * odd, -(gap * stiffness * odd));
        (to + value, change)
    }
}

/// A step of `dt` seconds.
#[inline(always)]
pub fn second_order<R: Real>(tau: R, inertia: R, dt: R) -> SecondOrder<R> {
    let stiffness = R::one() / inertia.max(R::of(1e-10));
    let sigma = tau * stiffness * R::of(0.5);
    let square = sigma.mul_add(sigma, -stiffness);
    // Equal roots are the limit of nearly equal ones.
    let root = square.abs().max(stiffness * R::of(1e-6)).sqrt();
    let oscillates = square.lt(R::zero());
    let (mut even, mut odd) = (R::zero(), R::zero());
    if (!oscillates).any() {
        // Real roots, the slower one written without a difference of equals.
        let (slow, fast) = ((-(stiffness / (sigma + root) * dt)).exp(), (-((sigma + root) * dt)).exp());
        (even, odd) = ((slow + fast) * R::of(0.5), (slow - fast) * R::of(0.5));
    }
    if oscillates.any() {
        let (sin, cos) = (root * dt * R::of(0.5 / std::f64::consts::PI)).sin_cos_turns();
        let decay = (-(sigma * dt)).exp();
        (even, odd) = (R::select(oscillates, decay * cos, even), R::select(oscillates, decay * sin, odd));
    }
    SecondOrder { sigma, stiffness, even, odd: odd / root }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Many small Euler steps of x' = v, v' = f(x, v).
    fn euler(mut x: f64, mut v: f64, seconds: f64, f: impl Fn(f64, f64) -> f64) -> (f64, f64) {
        let n = 400_000;
        for _ in 0..n {
            let a = f(x, v);
            (x, v) = (x + v * seconds / f64::from(n), v + a * seconds / f64::from(n));
        }
        (x, v)
    }

    #[test]
    fn second_order_rings_creeps_and_settles_as_integrated() {
        for (tau, inertia) in [(0.01, 1e-4), (0.02, 1e-4), (0.05, 1e-4), (0.012, 1e-6)] {
            let (x, v) = second_order(tau, inertia, 0.015).after(0.2, 3.0, -0.5);
            let (ex, ev) = euler(0.2, 3.0, 0.015, |x, v| (-0.5 - x - tau * v) / inertia);
            assert!((x - ex).abs() < 2e-4 && (v - ev).abs() < 0.03, "{tau} {inertia}: {x} {ex}, {v} {ev}");
        }
    }

    #[test]
    fn the_limit_holds_and_is_left() {
        let (tau, limit) = (0.02, 10.0);
        for dt in [0.001, 0.03, 0.1, 0.3] {
            let mut x = 0.0;
            for _ in 0..10_000 {
                x += ((1.0 - x) / tau).clamp(-limit, limit) * dt / 10_000.0;
            }
            let ours = limited(0.0, 1.0, tau, 1.0 / limit, dt, || (-dt / tau).exp());
            assert!((ours - x).abs() < 1e-3, "{dt}: {ours} {x}");
            assert_eq!(limited(0.0, -1.0, tau, 1.0 / limit, dt, || (-dt / tau).exp()), -ours);
        }
    }
}
