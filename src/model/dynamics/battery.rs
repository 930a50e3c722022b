//! Battery: linear discharge.

use crate::base::lane::Real;

/// Voltage after `dt` seconds at `rate` volts a second.
#[inline(always)]
pub fn discharged<R: Real>(voltage: R, rate: R, dt: R) -> R {
    rate.mul_add(dt, voltage)
}
