//! One number as a [`Real`]: `f32` and `f64`.

use super::{Mask, Real, Single, math};

macro_rules! scalar {
    ($t:ty, $fuses:literal, $exp:expr, $ln:expr, $tanh:expr, $tanh_pair:expr, $sin_cos:expr) => {
        impl Real for $t {
            type Mask = bool;
            const FUSES: bool = $fuses;
            #[inline(always)]
            fn of(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                <$t>::mul_add(self, a, b)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$t>::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline(always)]
            fn min(self, b: Self) -> Self {
                if self < b { self } else { b }
            }
            #[inline(always)]
            fn max(self, b: Self) -> Self {
                if self > b { self } else { b }
            }
            #[inline(always)]
            fn lt(self, b: Self) -> bool {
                self < b
            }
            #[inline(always)]
            fn le(self, b: Self) -> bool {
                self <= b
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                $ln(self)
            }
            #[inline(always)]
            fn tanh(self) -> Self {
                $tanh(self)
            }
            #[inline(always)]
            fn tanh_pair(pair: [Self; 2]) -> [Self; 2] {
                $tanh_pair(pair)
            }
            #[inline(always)]
            fn sin_cos_turns(self) -> (Self, Self) {
                $sin_cos(self)
            }
        }
    };
}
scalar!(f32, true, math::exp, math::ln, math::tanh, math::tanh_pair, math::sin_cos_turns);
scalar!(f64, true, f64::exp, f64::ln, f64::tanh, |x: [f64; 2]| x.map(f64::tanh), |x: f64| (x * std::f64::consts::TAU)
    .sin_cos());

impl Single for f32 {
    #[inline(always)]
    fn round(self) -> Self {
        self.round_ties_even()
    }
    #[inline(always)]
    fn pow2(self) -> Self {
        f32::from_bits(((self as i32 + 127) as u32) << 23)
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let bits = self.to_bits();
        let m = f32::from_bits((bits & 0x007f_ffff) | 0x3f00_0000);
        (m, (bits >> 23) as f32 - 126.0)
    }
}

impl Mask for bool {
    #[inline(always)]
    fn bits(self) -> u32 {
        self as u32
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        bits & 1 == 1
    }
}
