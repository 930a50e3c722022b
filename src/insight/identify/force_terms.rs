//! What is fitted of the specific force, and where it stands among a solution's values.

use super::solve::Solution;
use nalgebra::{DMatrix, DVector};

/// Order of a solution's values: time constant (s), c0..c5 (m/s2), drag along x, y, z (1/m), offsets along x, y (m/s2),
/// power of the voltage.
pub const TAU: usize = 0;
pub const THRUST: usize = 1;
pub const DRAG_AT: usize = 7;
pub const OFFSET: usize = 10;
pub const POWER: usize = 12;
pub const VALUES: usize = 13;

/// A curve of one number: proportional to the square of the throttle, as to that of a rotor's speed.
pub const SQUARE: [f64; 6] = [0.25, 0.5, 0.25, 0.0, 0.0, 0.0];

/// What is fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTerms {
    /// The thrust curve is a sum of these, each as c0..c5.
    pub curves: Vec<[f64; 6]>,
    /// The sum is the thrust at this voltage (V), and grows with a fitted power of it.
    pub power_at_v: Option<f64>,
    /// Drag, with the constant offsets of the specific force along x and y beside it.
    pub drag: bool,
    /// Drag along x, y, z that is not fitted, 1/m.
    pub given_drag: [f64; 3],
    /// The accelerometer's bias along x, y, z, m/s2; it is taken off.
    pub bias: [f64; 3],
    /// Cut-off of the zero-phase filter, Hz.
    pub cutoff_hz: f64,
    /// Voltages between which the curve has to be a vehicle's.
    pub volts: [f64; 2],
    /// Gravity, m/s2.
    pub gravity: f64,
}

impl ForceTerms {
    /// The terms of a whole curve: c0..c3, with c4 and c5 where the voltage tells them.
    pub fn curve(by_voltage: bool) -> Vec<[f64; 6]> {
        let unit = |k: usize| std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
        (0..if by_voltage { 6 } else { 4 }).map(unit).collect()
    }

    /// Whether the thrust is one of the voltage too.
    pub fn by_voltage(&self) -> bool {
        self.power_at_v.is_some() || self.curves.iter().any(|c| c[4] != 0.0 || c[5] != 0.0)
    }
}

/// Where the unknowns of a fit are among a solution's values.
pub struct ForceColumns<'a> {
    pub terms: &'a ForceTerms,
    pub lags: bool,
}

impl ForceColumns<'_> {
    /// The values are this matrix times the unknowns.
    fn matrix(&self) -> DMatrix<f64> {
        let first = usize::from(self.lags);
        let n = self.terms.curves.len();
        let rest = if self.terms.drag { POWER - DRAG_AT } else { 0 };
        let power = usize::from(self.terms.power_at_v.is_some());
        let mut out = DMatrix::zeros(VALUES, first + n + rest + power);
        if self.lags {
            out[(TAU, 0)] = 1.0;
        }
        for (j, curve) in self.terms.curves.iter().enumerate() {
            (0..6).for_each(|k| out[(THRUST + k, first + j)] = curve[k]);
        }
        (0..rest).for_each(|k| out[(DRAG_AT + k, first + n + k)] = 1.0);
        (0..power).for_each(|k| out[(POWER, first + n + rest + k)] = 1.0);
        out
    }

    pub fn values(&self, x: &[f64]) -> Vec<f64> {
        (self.matrix() * DVector::from_column_slice(x)).iter().copied().collect()
    }

    pub fn solution(&self, found: &Solution) -> Solution {
        let matrix = self.matrix();
        let touched = |i: usize| (0..matrix.ncols()).any(|j| matrix[(i, j)] != 0.0 && found.at_bound[j]);
        Solution {
            values: self.values(&found.values),
            covariance: &matrix * &found.covariance * matrix.transpose(),
            at_bound: (0..VALUES).map(touched).collect(),
            noise: found.noise.clone(),
        }
    }
}
