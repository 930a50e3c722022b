//! The block in four registers of 128 bits, which every x86-64 has: what runs where AVX2 is not. Multiply-add is not
//! fused, and results are those of [`super::super::Portable`] bit for bit.

use crate::base::lane::{Bits, LANES, Lane, Lane32, Mask, Real, Single, Tiled, Word, math};
use std::arch::x86_64::*;
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

#[derive(Clone, Copy)]
pub struct Sse2([__m128; 4]);
#[derive(Clone, Copy)]
pub struct Sse2Bits([__m128i; 4]);
#[derive(Clone, Copy)]
pub struct Sse2Mask([__m128; 4]);

/// `quad!(f, a, b)` applies `f` to all four registers. SSE2 is part of x86-64: nothing here can be missing.
macro_rules! quad {
    ($f:expr, $a:expr) => {{
        let a = $a;
        // SAFETY: arithmetic in registers.
        #[allow(unused_unsafe)]
        unsafe {
            [$f(a[0]), $f(a[1]), $f(a[2]), $f(a[3])]
        }
    }};
    ($f:expr, $a:expr, $b:expr) => {{
        let (a, b) = ($a, $b);
        // SAFETY: arithmetic in registers.
        #[allow(unused_unsafe)]
        unsafe {
            [$f(a[0], b[0]), $f(a[1], b[1]), $f(a[2], b[2]), $f(a[3], b[3])]
        }
    }};
}

macro_rules! binary {
    ($t:ty, $trait:ident, $f:ident, $op:expr) => {
        impl $trait for $t {
            type Output = Self;
            #[inline(always)]
            fn $f(self, b: Self) -> Self {
                Self(quad!($op, self.0, b.0))
            }
        }
    };
}
binary!(Sse2, Add, add, _mm_add_ps);
binary!(Sse2, Sub, sub, _mm_sub_ps);
binary!(Sse2, Mul, mul, _mm_mul_ps);
binary!(Sse2, Div, div, _mm_div_ps);
binary!(Sse2Bits, BitXor, bitxor, _mm_xor_si128);
binary!(Sse2Bits, BitAnd, bitand, _mm_and_si128);
binary!(Sse2Mask, BitAnd, bitand, _mm_and_ps);
binary!(Sse2Mask, BitOr, bitor, _mm_or_ps);

/// `yes` where all bits of `mask` are set, `no` where none is.
#[inline(always)]
fn blend(mask: __m128, yes: __m128, no: __m128) -> __m128 {
    // SAFETY: arithmetic in registers.
    unsafe { _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no)) }
}

impl Neg for Sse2 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(quad!(|a| _mm_xor_ps(a, _mm_set1_ps(-0.0)), self.0))
    }
}

impl Not for Sse2Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(quad!(|a| _mm_xor_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-1))), self.0))
    }
}
impl Mask for Sse2Mask {
    #[inline(always)]
    fn bits(self) -> u32 {
        let m = quad!(_mm_movemask_ps, self.0);
        (m[0] | m[1] << 4 | m[2] << 8 | m[3] << 12) as u32
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self(from_fn(|q| {
            // SAFETY: arithmetic in registers.
            unsafe {
                let select = _mm_setr_epi32(1, 2, 4, 8);
                let set = _mm_and_si128(_mm_set1_epi32((bits >> (4 * q)) as i32), select);
                _mm_castsi128_ps(_mm_cmpeq_epi32(set, select))
            }
        }))
    }
}

impl Real for Sse2 {
    type Mask = Sse2Mask;
    const FUSES: bool = false;
    #[inline(always)]
    fn of(x: f64) -> Self {
        // SAFETY: arithmetic in registers.
        Self([unsafe { _mm_set1_ps(x as f32) }; 4])
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(quad!(_mm_sqrt_ps, self.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(quad!(|a| _mm_andnot_ps(_mm_set1_ps(-0.0), a), self.0))
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        Self(quad!(_mm_min_ps, self.0, b.0))
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        Self(quad!(_mm_max_ps, self.0, b.0))
    }
    #[inline(always)]
    fn lt(self, b: Self) -> Sse2Mask {
        Sse2Mask(quad!(_mm_cmplt_ps, self.0, b.0))
    }
    #[inline(always)]
    fn le(self, b: Self) -> Sse2Mask {
        Sse2Mask(quad!(_mm_cmple_ps, self.0, b.0))
    }
    #[inline(always)]
    fn select(mask: Sse2Mask, yes: Self, no: Self) -> Self {
        Self([0, 1, 2, 3].map(
            #[inline(always)]
            |q| blend(mask.0[q], yes.0[q], no.0[q]),
        ))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        math::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        math::ln(self)
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        math::tanh(self)
    }
    #[inline(always)]
    fn tanh_pair(pair: [Self; 2]) -> [Self; 2] {
        math::tanh_pair(pair)
    }
    #[inline(always)]
    fn sin_cos_turns(self) -> (Self, Self) {
        math::sin_cos_turns(self)
    }
    #[inline(always)]
    fn vectorize<T>(f: impl FnOnce() -> T) -> T {
        // A function of its own, as wider blocks have it.
        #[inline(never)]
        fn inner<T>(f: impl FnOnce() -> T) -> T {
            f()
        }
        inner(f)
    }
}

impl Single for Sse2 {
    #[inline(always)]
    fn round(self) -> Self {
        // Adding and taking away 1.5 * 2^23 rounds to even; what is larger than 2^22 has next to nothing after the
        // point.
        let magic = Self::of(12_582_912.0);
        Self::select(self.abs().lt(Self::of(4_194_304.0)), (self + magic) - magic, self)
    }
    #[inline(always)]
    fn pow2(self) -> Self {
        Self(quad!(
            |a| _mm_castsi128_ps(_mm_slli_epi32::<23>(_mm_add_epi32(_mm_cvtps_epi32(a), _mm_set1_epi32(127)))),
            self.0
        ))
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        // SAFETY: arithmetic in registers.
        let mantissa = |a| unsafe {
            let fraction = _mm_and_si128(_mm_castps_si128(a), _mm_set1_epi32(0x007f_ffff));
            _mm_castsi128_ps(_mm_or_si128(fraction, _mm_set1_epi32(0x3f00_0000)))
        };
        // SAFETY: arithmetic in registers.
        let exponent = |a| unsafe { _mm_cvtepi32_ps(_mm_srli_epi32::<23>(_mm_castps_si128(a))) };
        (Self(quad!(mantissa, self.0)), Self(quad!(exponent, self.0)) - Self::of(126.0))
    }
}

impl Lane for Sse2 {
    type Elem = f32;
    // 8 accumulators of 16 registers that hold a quarter of a block each.
    #[inline(always)]
    fn tiled<T: Tiled>(work: T) {
        work.run::<1, 2>()
    }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self::of(x as f64)
    }
    #[inline(always)]
    fn from_array(x: [f32; LANES]) -> Self {
        // SAFETY: the array has the length of a block.
        unsafe { Self::load(x.as_ptr()) }
    }
    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        let mut x = [0.0; LANES];
        // SAFETY: the array has the length of a block.
        unsafe { self.store(x.as_mut_ptr()) };
        x
    }
    #[inline(always)]
    unsafe fn load(p: *const f32) -> Self {
        // SAFETY: promised by the caller.
        Self(quad!(|q: usize| _mm_loadu_ps(p.add(4 * q)), [0, 1, 2, 3]))
    }
    #[inline(always)]
    unsafe fn store(self, p: *mut f32) {
        // SAFETY: promised by the caller.
        unsafe { (0..4).for_each(|q| _mm_storeu_ps(p.add(4 * q), self.0[q])) }
    }
    #[inline(always)]
    fn transpose(rows: &mut [Self; LANES]) {
        let old = *rows;
        for down in 0..4 {
            for across in 0..4 {
                let mut r: [__m128; 4] = from_fn(|i| old[4 * down + i].0[across]);
                let [a, b, c, d] = &mut r;
                // SAFETY: arithmetic in registers.
                unsafe { _MM_TRANSPOSE4_PS(a, b, c, d) };
                (0..4).for_each(|i| rows[4 * across + i].0[down] = r[i]);
            }
        }
    }
}

impl Lane32 for Sse2 {
    type Bits = Sse2Bits;
    #[inline(always)]
    fn from_bits(bits: Sse2Bits) -> Self {
        Self(quad!(_mm_cvtepi32_ps, bits.0))
    }
}

impl Word for Sse2Bits {
    #[inline(always)]
    fn splat(x: u32) -> Self {
        // SAFETY: arithmetic in registers.
        Self([unsafe { _mm_set1_epi32(x as i32) }; 4])
    }
    #[inline(always)]
    fn mul_wide(self, x: u32) -> (Self, Self) {
        // The instruction multiplies the even lanes; the odd ones are shifted down for it.
        // SAFETY: arithmetic in registers.
        let (x, odd) = unsafe { (_mm_set1_epi32(x as i32), _mm_set1_epi64x(0xffff_ffff_0000_0000_u64 as i64)) };
        // SAFETY: arithmetic in registers.
        let high = |a| unsafe {
            let (e, o) = (_mm_mul_epu32(a, x), _mm_mul_epu32(_mm_srli_epi64::<32>(a), x));
            _mm_or_si128(_mm_srli_epi64::<32>(e), _mm_and_si128(o, odd))
        };
        // SAFETY: arithmetic in registers.
        let low = |a| unsafe {
            let (e, o) = (_mm_mul_epu32(a, x), _mm_mul_epu32(_mm_srli_epi64::<32>(a), x));
            _mm_or_si128(_mm_andnot_si128(odd, e), _mm_slli_epi64::<32>(o))
        };
        (Self(quad!(high, self.0)), Self(quad!(low, self.0)))
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        // SAFETY: arithmetic in registers.
        let count = unsafe { _mm_cvtsi32_si128(N as i32) };
        Self(quad!(|a| _mm_srl_epi32(a, count), self.0))
    }
}
impl Bits for Sse2Bits {
    #[inline(always)]
    fn from_array(x: [u32; LANES]) -> Self {
        let p = x.as_ptr();
        // SAFETY: the array has the length of a block.
        Self(quad!(|q: usize| _mm_loadu_si128(p.add(4 * q).cast()), [0, 1, 2, 3]))
    }
    #[inline(always)]
    fn to_array(self) -> [u32; LANES] {
        let mut x = [0; LANES];
        let p: *mut u32 = x.as_mut_ptr();
        // SAFETY: the array has the length of a block.
        unsafe { (0..4).for_each(|q| _mm_storeu_si128(p.add(4 * q).cast(), self.0[q])) };
        x
    }
}
