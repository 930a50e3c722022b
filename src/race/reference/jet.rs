//! A number with its first and second derivatives by `N` variables.

use crate::base::lane::{Mask, Real};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A function's value at a point, its gradient and its symmetric matrix of second derivatives there.
#[derive(Clone, Copy, Debug)]
pub struct Jet<const N: usize> {
    pub value: f64,
    pub slope: [f64; N],
    pub curve: [[f64; N]; N],
}

impl<const N: usize> Jet<N> {
    /// Variable `k` at `value`.
    pub fn variable(value: f64, k: usize) -> Self {
        let mut jet = Self::of(value);
        jet.slope[k] = 1.0;
        jet
    }

    /// f(self), of the value `f` and the derivatives `d` and `dd` of f there.
    fn chain(self, f: f64, d: f64, dd: f64) -> Self {
        let mut out = Self { value: f, slope: self.slope.map(|s| d * s), curve: self.curve };
        for i in 0..N {
            for j in 0..N {
                out.curve[i][j] = d * self.curve[i][j] + dd * self.slope[i] * self.slope[j];
            }
        }
        out
    }

    /// `a self + b other`, with the value `value`.
    fn sum(self, a: f64, other: Self, b: f64, value: f64) -> Self {
        let mut out = Self { value, ..self };
        for i in 0..N {
            out.slope[i] = a * self.slope[i] + b * other.slope[i];
            for j in 0..N {
                out.curve[i][j] = a * self.curve[i][j] + b * other.curve[i][j];
            }
        }
        out
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        self.sum(1.0, b, 1.0, self.value + b.value)
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self.sum(1.0, b, -1.0, self.value - b.value)
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let mut out = self.sum(b.value, b, self.value, self.value * b.value);
        for i in 0..N {
            for j in 0..N {
                out.curve[i][j] += self.slope[i] * b.slope[j] + self.slope[j] * b.slope[i];
            }
        }
        out
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let inverse = 1.0 / b.value;
        self * b.chain(inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse)
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0, 0.0)
    }
}

/// Comparisons are those of the values.
impl<const N: usize> Real for Jet<N> {
    type Mask = bool;
    const FUSES: bool = false;

    fn of(x: f64) -> Self {
        Self { value: x, slope: [0.0; N], curve: [[0.0; N]; N] }
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root, -0.25 / (root * self.value))
    }
    fn abs(self) -> Self {
        Self::select(self.value < 0.0, -self, self)
    }
    fn min(self, b: Self) -> Self {
        Self::select(self.lt(b), self, b)
    }
    fn max(self, b: Self) -> Self {
        Self::select(b.lt(self), self, b)
    }
    fn lt(self, b: Self) -> bool {
        self.value < b.value
    }
    fn le(self, b: Self) -> bool {
        self.value <= b.value
    }
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask.any() { yes } else { no }
    }
    fn exp(self) -> Self {
        let e = self.value.exp();
        self.chain(e, e, e)
    }
    fn ln(self) -> Self {
        let inverse = 1.0 / self.value;
        self.chain(self.value.ln(), inverse, -inverse * inverse)
    }
    fn tanh(self) -> Self {
        let t = self.value.tanh();
        let d = 1.0 - t * t;
        self.chain(t, d, -2.0 * t * d)
    }
    fn tanh_pair(pair: [Self; 2]) -> [Self; 2] {
        pair.map(Self::tanh)
    }
    fn sin_cos_turns(self) -> (Self, Self) {
        const TURN: f64 = std::f64::consts::TAU;
        let (sin, cos) = (TURN * self.value).sin_cos();
        let squared = TURN * TURN;
        (self.chain(sin, TURN * cos, -squared * sin), self.chain(cos, -TURN * sin, -squared * cos))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Some of everything.
    fn f<R: Real>(x: R, y: R) -> R {
        let (sin, cos) = (x * R::of(0.1)).sin_cos_turns();
        let z = (x * x + y.exp()).sqrt() / (y - R::of(4.0)) + (x * y).tanh() * sin - cos * (x + R::of(5.0)).ln();
        z.mul_add(x, y.abs()).max(R::of(-100.0)).min(-z + R::of(100.0))
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let h = 1e-4;
        for (x, y) in [(0.3, -0.7), (1.2, 0.4), (-2.0, 1.1)] {
            let jet = f(Jet::<2>::variable(x, 0), Jet::variable(y, 1));
            assert!((jet.value - f(x, y)).abs() < 1e-12);
            let slope = [(f(x + h, y) - f(x - h, y)) / (2.0 * h), (f(x, y + h) - f(x, y - h)) / (2.0 * h)];
            let xx = (f(x + h, y) - 2.0 * f(x, y) + f(x - h, y)) / (h * h);
            let yy = (f(x, y + h) - 2.0 * f(x, y) + f(x, y - h)) / (h * h);
            let xy = (f(x + h, y + h) - f(x + h, y - h) - f(x - h, y + h) + f(x - h, y - h)) / (4.0 * h * h);
            for k in 0..2 {
                assert!((jet.slope[k] - slope[k]).abs() < 1e-5, "{jet:?} {slope:?}");
            }
            for (ours, theirs) in [(jet.curve[0][0], xx), (jet.curve[1][1], yy), (jet.curve[0][1], xy)] {
                assert!((ours - theirs).abs() < 1e-4, "{jet:?} {theirs}");
            }
            assert!((jet.curve[0][1] - jet.curve[1][0]).abs() < 1e-12, "{jet:?}");
        }
    }
}
