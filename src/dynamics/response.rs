//! First-order response of the inner loop to commands (paper Eq. 6).

use crate::lane::Real;

/// 1 - exp(-dt / tau): the share of the gap between command and response that closes in `dt` seconds.
pub fn alpha(tau: f64, dt: f64) -> f64 {
    -f64::exp_m1(-dt / tau)
}

/// `from` moved toward `to` by the share `alpha`.
#[inline(always)]
pub fn toward<R: Real>(from: R, to: R, alpha: R) -> R {
    alpha.mul_add(to - from, from)
}
