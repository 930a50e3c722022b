//! Collective thrust over filtered command and battery voltage (paper Eq. 7).

pub mod shape;

use crate::base::lane::Real;

/// c0 + c1 u + c2 u^2 + c3 u^3 + c4 V + c5 u V; newtons, or m/s2 where the coefficients are divided by the mass.
#[inline(always)]
pub fn specific_thrust<R: Real>(c: &[R; 6], u: R, voltage: R) -> R {
    let cubic = c[3].mul_add(u, c[2]).mul_add(u, c[1]).mul_add(u, c[0]);
    let by_voltage = c[5].mul_add(u, c[4]);
    by_voltage.mul_add(voltage, cubic)
}
