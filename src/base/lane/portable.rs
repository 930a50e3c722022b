//! The block as an array of 16 numbers: for CPUs without a block of their own, and for `f64` gradient checks.

use super::{Bits, LANES, Lane, Lane32, Mask, Real, Single, Tiled, Word};
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// 16 numbers, one operation at a time.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Portable<E>(pub [E; LANES]);

/// A truth value for each lane of a [`Portable`] block.
#[derive(Clone, Copy, Debug)]
pub struct Truth([bool; LANES]);

macro_rules! lanewise {
    ($trait:ident, $f:ident) => {
        impl<E: Real> $trait for Portable<E> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, b: Self) -> Self {
                Portable(from_fn(|i| self.0[i].$f(b.0[i])))
            }
        }
    };
}
lanewise!(Add, add);
lanewise!(Sub, sub);
lanewise!(Mul, mul);
lanewise!(Div, div);

impl<E: Real> Neg for Portable<E> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Portable(from_fn(|i| -self.0[i]))
    }
}

impl BitAnd for Truth {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Truth(from_fn(|i| self.0[i] & b.0[i]))
    }
}
impl BitOr for Truth {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        Truth(from_fn(|i| self.0[i] | b.0[i]))
    }
}
impl Not for Truth {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Truth(from_fn(|i| !self.0[i]))
    }
}
impl Mask for Truth {
    #[inline(always)]
    fn bits(self) -> u32 {
        (0..LANES).fold(0, |b, i| b | (self.0[i] as u32) << i)
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Truth(from_fn(|i| bits >> i & 1 == 1))
    }
}

impl<E: Real<Mask = bool>> Real for Portable<E> {
    type Mask = Truth;
    const FUSES: bool = false;

    #[inline(always)]
    fn of(x: f64) -> Self {
        Portable([E::of(x); LANES])
    }
    // Not fused: without the instruction, a fused multiply-add is a call into the C library.
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Portable(self.0.map(E::sqrt))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Portable(self.0.map(E::abs))
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        Portable(from_fn(|i| self.0[i].min(b.0[i])))
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        Portable(from_fn(|i| self.0[i].max(b.0[i])))
    }
    #[inline(always)]
    fn lt(self, b: Self) -> Truth {
        Truth(from_fn(|i| self.0[i].lt(b.0[i])))
    }
    #[inline(always)]
    fn le(self, b: Self) -> Truth {
        Truth(from_fn(|i| self.0[i].le(b.0[i])))
    }
    #[inline(always)]
    fn select(mask: Truth, yes: Self, no: Self) -> Self {
        Portable(from_fn(|i| E::select(mask.0[i], yes.0[i], no.0[i])))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        Portable(self.0.map(E::exp))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        Portable(self.0.map(E::ln))
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        Portable(self.0.map(E::tanh))
    }
    #[inline(always)]
    fn tanh_pair([a, b]: [Self; 2]) -> [Self; 2] {
        let both: [[E; 2]; LANES] = from_fn(|i| E::tanh_pair([a.0[i], b.0[i]]));
        [Portable(both.map(|x| x[0])), Portable(both.map(|x| x[1]))]
    }
    #[inline(always)]
    fn sin_cos_turns(self) -> (Self, Self) {
        let both = self.0.map(E::sin_cos_turns);
        (Portable(both.map(|x| x.0)), Portable(both.map(|x| x.1)))
    }
}

macro_rules! lane {
    ($e:ty) => {
        impl Lane for Portable<$e> {
            type Elem = $e;
            // 8 accumulators of 16 registers that hold a quarter of a block each.
            #[inline(always)]
            fn tiled<T: Tiled>(work: T) {
                work.run::<1, 2>()
            }
            #[inline(always)]
            fn splat(x: $e) -> Self {
                Portable([x; LANES])
            }
            #[inline(always)]
            fn from_array(x: [$e; LANES]) -> Self {
                Portable(x)
            }
            #[inline(always)]
            fn to_array(self) -> [$e; LANES] {
                self.0
            }
            #[inline(always)]
            unsafe fn load(p: *const $e) -> Self {
                // SAFETY: promised by the caller.
                Portable(unsafe { p.cast::<[$e; LANES]>().read_unaligned() })
            }
            #[inline(always)]
            unsafe fn store(self, p: *mut $e) {
                // SAFETY: promised by the caller.
                unsafe { p.cast::<[$e; LANES]>().write_unaligned(self.0) }
            }
            #[inline(always)]
            fn transpose(rows: &mut [Self; LANES]) {
                let old = *rows;
                *rows = from_fn(|i| Portable(from_fn(|j| old[j].0[i])));
            }
        }
    };
}
lane!(f32);
lane!(f64);

impl Single for Portable<f32> {
    #[inline(always)]
    fn round(self) -> Self {
        // Adding and taking away 1.5 * 2^23 rounds to even and, unlike the library call, is two instructions.
        const MAGIC: f32 = 12_582_912.0;
        Portable(self.0.map(|x| if x.abs() < 4_194_304.0 { (x + MAGIC) - MAGIC } else { x }))
    }
    #[inline(always)]
    fn pow2(self) -> Self {
        Portable(self.0.map(Single::pow2))
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let both = self.0.map(Single::split_exponent);
        (Portable(both.map(|x| x.0)), Portable(both.map(|x| x.1)))
    }
}

impl Lane32 for Portable<f32> {
    type Bits = Portable<u32>;
    #[inline(always)]
    fn from_bits(bits: Portable<u32>) -> Self {
        Portable(bits.0.map(|b| b as i32 as f32))
    }
    #[inline(always)]
    fn bf16_pairs(first: Self, second: Self) -> Self {
        Portable(from_fn(|i| f32::from_bits(super::bf16::pair(first.0[i], second.0[i]))))
    }
}

impl BitXor for Portable<u32> {
    type Output = Self;
    #[inline(always)]
    fn bitxor(self, b: Self) -> Self {
        Portable(from_fn(|i| self.0[i] ^ b.0[i]))
    }
}
impl BitAnd for Portable<u32> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Portable(from_fn(|i| self.0[i] & b.0[i]))
    }
}
impl Word for Portable<u32> {
    #[inline(always)]
    fn splat(x: u32) -> Self {
        Portable([x; LANES])
    }
    #[inline(always)]
    fn mul_wide(self, x: u32) -> (Self, Self) {
        let wide = self.0.map(|a| a as u64 * x as u64);
        (Portable(wide.map(|w| (w >> 32) as u32)), Portable(wide.map(|w| w as u32)))
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        Portable(self.0.map(|a| a >> N))
    }
}
impl Bits for Portable<u32> {
    #[inline(always)]
    fn from_array(x: [u32; LANES]) -> Self {
        Portable(x)
    }
    #[inline(always)]
    fn to_array(self) -> [u32; LANES] {
        self.0
    }
}
