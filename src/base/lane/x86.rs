//! The block in x86-64 registers: one of 512 bits, or two of 256.
//!
//! Soundness: the types are private to `lane` and are reached only through [`super::dispatch`], which has checked the
//! CPU; so the instructions they use exist wherever they do.

mod sse2;

use super::{Bits, LANES, Lane, Lane32, Mask, Real, Single, Tiled, Word, math};
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

pub use sse2::Sse2;

pub fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}
pub fn has_avx512() -> bool {
    has_avx2() && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
}

#[derive(Clone, Copy)]
pub struct Avx512(__m512);
#[derive(Clone, Copy)]
pub struct Avx512Bits(__m512i);
#[derive(Clone, Copy)]
pub struct Avx2([__m256; 2]);
#[derive(Clone, Copy)]
pub struct Avx2Bits([__m256i; 2]);
#[derive(Clone, Copy)]
pub struct Avx2Mask([__m256; 2]);

/// `pair!(f, a, b)` applies `f` to both halves.
macro_rules! pair {
    ($f:expr, $a:expr) => {{
        let a = $a;
        // SAFETY: see the module's page.
        unsafe { [$f(a[0]), $f(a[1])] }
    }};
    ($f:expr, $a:expr, $b:expr) => {{
        let (a, b) = ($a, $b);
        // SAFETY: see the module's page.
        unsafe { [$f(a[0], b[0]), $f(a[1], b[1])] }
    }};
    ($f:expr, $a:expr, $b:expr, $c:expr) => {{
        let (a, b, c) = ($a, $b, $c);
        // SAFETY: see the module's page.
        unsafe { [$f(a[0], b[0], c[0]), $f(a[1], b[1], c[1])] }
    }};
}

macro_rules! binary {
    ($t:ty, $trait:ident, $f:ident, |$a:ident, $b:ident| $body:expr) => {
        impl $trait for $t {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: see the module's page.
                #[allow(unused_unsafe)]
                Self(unsafe { $body })
            }
        }
    };
}
binary!(Avx512, Add, add, |a, b| _mm512_add_ps(a, b));
binary!(Avx512, Sub, sub, |a, b| _mm512_sub_ps(a, b));
binary!(Avx512, Mul, mul, |a, b| _mm512_mul_ps(a, b));
binary!(Avx512, Div, div, |a, b| _mm512_div_ps(a, b));
binary!(Avx512Bits, BitXor, bitxor, |a, b| _mm512_xor_si512(a, b));
binary!(Avx512Bits, BitAnd, bitand, |a, b| _mm512_and_si512(a, b));
binary!(Avx2, Add, add, |a, b| pair!(_mm256_add_ps, a, b));
binary!(Avx2, Sub, sub, |a, b| pair!(_mm256_sub_ps, a, b));
binary!(Avx2, Mul, mul, |a, b| pair!(_mm256_mul_ps, a, b));
binary!(Avx2, Div, div, |a, b| pair!(_mm256_div_ps, a, b));
binary!(Avx2Bits, BitXor, bitxor, |a, b| pair!(_mm256_xor_si256, a, b));
binary!(Avx2Bits, BitAnd, bitand, |a, b| pair!(_mm256_and_si256, a, b));
binary!(Avx2Mask, BitAnd, bitand, |a, b| pair!(_mm256_and_ps, a, b));
binary!(Avx2Mask, BitOr, bitor, |a, b| pair!(_mm256_or_ps, a, b));

impl Neg for Avx512 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: see the module's page.
        Self(unsafe { _mm512_xor_ps(self.0, _mm512_set1_ps(-0.0)) })
    }
}
impl Neg for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(pair!(|a| _mm256_xor_ps(a, _mm256_set1_ps(-0.0)), self.0))
    }
}

impl Mask for u16 {
    #[inline(always)]
    fn bits(self) -> u32 {
        self as u32
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        bits as u16
    }
}

impl Not for Avx2Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(pair!(|a| _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1))), self.0))
    }
}
impl Mask for Avx2Mask {
    #[inline(always)]
    fn bits(self) -> u32 {
        let m = pair!(_mm256_movemask_ps, self.0);
        m[0] as u32 | (m[1] as u32) << 8
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        let half = |b: i32| {
            // SAFETY: see the module's page.
            unsafe {
                let select = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
                let set = _mm256_and_si256(_mm256_set1_epi32(b), select);
                _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, select))
            }
        };
        Self([half(bits as i32), half((bits >> 8) as i32)])
    }
}

macro_rules! real {
    (
        $t:ty, $mask:ty, $features:literal, $of:expr, $fma:expr, $sqrt:expr, $abs:expr,
        $min:expr, $max:expr, $lt:expr, $le:expr, $select:expr
    ) => {
        impl Real for $t {
            type Mask = $mask;
            const FUSES: bool = true;
            #[inline(always)]
            fn vectorize<T>(f: impl FnOnce() -> T) -> T {
                #[target_feature(enable = $features)]
                fn inner<T>(f: impl FnOnce() -> T) -> T {
                    f()
                }
                // SAFETY: see the module's page.
                unsafe { inner(f) }
            }
            #[inline(always)]
            fn of(x: f64) -> Self {
                $of(x as f32)
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                $fma(self, a, b)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $abs(self)
            }
            #[inline(always)]
            fn min(self, b: Self) -> Self {
                $min(self, b)
            }
            #[inline(always)]
            fn max(self, b: Self) -> Self {
                $max(self, b)
            }
            #[inline(always)]
            fn lt(self, b: Self) -> $mask {
                $lt(self, b)
            }
            #[inline(always)]
            fn le(self, b: Self) -> $mask {
                $le(self, b)
            }
            #[inline(always)]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                $select(mask, yes, no)
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
        }
    };
}
// SAFETY (all closures): see the module's page.
real!(
    Avx512,
    u16,
    "avx512f,avx512dq,avx2,fma",
    |x| Avx512(unsafe { _mm512_set1_ps(x) }),
    |s: Avx512, a: Avx512, b: Avx512| Avx512(unsafe { _mm512_fmadd_ps(s.0, a.0, b.0) }),
    |s: Avx512| Avx512(unsafe { _mm512_sqrt_ps(s.0) }),
    |s: Avx512| Avx512(unsafe { _mm512_abs_ps(s.0) }),
    |s: Avx512, b: Avx512| Avx512(unsafe { _mm512_min_ps(s.0, b.0) }),
    |s: Avx512, b: Avx512| Avx512(unsafe { _mm512_max_ps(s.0, b.0) }),
    |s: Avx512, b: Avx512| unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(s.0, b.0) },
    |s: Avx512, b: Avx512| unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(s.0, b.0) },
    |m, y: Avx512, n: Avx512| Avx512(unsafe { _mm512_mask_blend_ps(m, n.0, y.0) })
);
real!(
    Avx2,
    Avx2Mask,
    "avx2,fma",
    |x| Avx2([unsafe { _mm256_set1_ps(x) }; 2]),
    |s: Avx2, a: Avx2, b: Avx2| Avx2(pair!(_mm256_fmadd_ps, s.0, a.0, b.0)),
    |s: Avx2| Avx2(pair!(_mm256_sqrt_ps, s.0)),
    |s: Avx2| Avx2(pair!(|a| _mm256_andnot_ps(_mm256_set1_ps(-0.0), a), s.0)),
    |s: Avx2, b: Avx2| Avx2(pair!(_mm256_min_ps, s.0, b.0)),
    |s: Avx2, b: Avx2| Avx2(pair!(_mm256_max_ps, s.0, b.0)),
    |s: Avx2, b: Avx2| Avx2Mask(pair!(_mm256_cmp_ps::<_CMP_LT_OQ>, s.0, b.0)),
    |s: Avx2, b: Avx2| Avx2Mask(pair!(_mm256_cmp_ps::<_CMP_LE_OQ>, s.0, b.0)),
    |m: Avx2Mask, y: Avx2, n: Avx2| Avx2(pair!(_mm256_blendv_ps, n.0, y.0, m.0))
);

impl Single for Avx512 {
    #[inline(always)]
    fn round(self) -> Self {
        // SAFETY: see the module's page.
        Self(unsafe { _mm512_roundscale_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0) })
    }
    #[inline(always)]
    fn pow2(self) -> Self {
        // SAFETY: see the module's page.
        Self(unsafe { _mm512_scalef_ps(_mm512_set1_ps(1.0), self.0) })
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        // SAFETY: see the module's page.
        unsafe {
            let m = _mm512_getmant_ps::<_MM_MANT_NORM_P5_1, _MM_MANT_SIGN_SRC>(self.0);
            (Self(m), Self(_mm512_getexp_ps(self.0)) + Self::one())
        }
    }
}
impl Single for Avx2 {
    #[inline(always)]
    fn round(self) -> Self {
        Self(pair!(_mm256_round_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>, self.0))
    }
    #[inline(always)]
    fn pow2(self) -> Self {
        let half = |a| {
            // SAFETY: see the module's page.
            unsafe {
                let biased = _mm256_add_epi32(_mm256_cvtps_epi32(a), _mm256_set1_epi32(127));
                _mm256_castsi256_ps(_mm256_slli_epi32::<23>(biased))
            }
        };
        Self(self.0.map(half))
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let half = |a| {
            // SAFETY: see the module's page.
            unsafe {
                let bits = _mm256_castps_si256(a);
                let fraction = _mm256_and_si256(bits, _mm256_set1_epi32(0x007f_ffff));
                let m = _mm256_castsi256_ps(_mm256_or_si256(fraction, _mm256_set1_epi32(0x3f00_0000)));
                (m, _mm256_cvtepi32_ps(_mm256_srli_epi32::<23>(bits)))
            }
        };
        let [a, b] = self.0.map(half);
        (Self([a.0, b.0]), Self([a.1, b.1]) - Self::of(126.0))
    }
}

/// Transposing through memory: two passes of 16 stores and 256 scalar moves would be slow, so registers are unpacked.
#[inline(always)]
fn transpose_avx512(r: &mut [Avx512; LANES]) {
    // SAFETY: see the module's page.
    unsafe {
        let mut t = [_mm512_setzero_ps(); LANES];
        for i in 0..4 {
            let (a, b, c, d) = (r[4 * i].0, r[4 * i + 1].0, r[4 * i + 2].0, r[4 * i + 3].0);
            let (ab0, ab1) = (_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b));
            let (cd0, cd1) = (_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d));
            t[4 * i] = _mm512_shuffle_ps::<0x44>(ab0, cd0);
            t[4 * i + 1] = _mm512_shuffle_ps::<0xee>(ab0, cd0);
            t[4 * i + 2] = _mm512_shuffle_ps::<0x44>(ab1, cd1);
            t[4 * i + 3] = _mm512_shuffle_ps::<0xee>(ab1, cd1);
        }
        for k in 0..4 {
            let (a, b, c, d) = (t[k], t[4 + k], t[8 + k], t[12 + k]);
            let (ab0, ab1) = (_mm512_shuffle_f32x4::<0x88>(a, b), _mm512_shuffle_f32x4::<0xdd>(a, b));
            let (cd0, cd1) = (_mm512_shuffle_f32x4::<0x88>(c, d), _mm512_shuffle_f32x4::<0xdd>(c, d));
            r[k] = Avx512(_mm512_shuffle_f32x4::<0x88>(ab0, cd0));
            r[8 + k] = Avx512(_mm512_shuffle_f32x4::<0xdd>(ab0, cd0));
            r[4 + k] = Avx512(_mm512_shuffle_f32x4::<0x88>(ab1, cd1));
            r[12 + k] = Avx512(_mm512_shuffle_f32x4::<0xdd>(ab1, cd1));
        }
    }
}

/// Halves of two rows are added at a time, in the order of [`Lane::sum`]: 30 shuffles where a transpose takes 64.
#[inline(always)]
fn row_sums_avx512(r: [Avx512; LANES]) -> Avx512 {
    // SAFETY: see the module's page.
    unsafe {
        let halves = |a, b| _mm512_add_ps(_mm512_shuffle_f32x4::<0x44>(a, b), _mm512_shuffle_f32x4::<0xee>(a, b));
        let quarters = |a, b| _mm512_add_ps(_mm512_shuffle_f32x4::<0x88>(a, b), _mm512_shuffle_f32x4::<0xdd>(a, b));
        let pairs = |a, b| _mm512_add_ps(_mm512_shuffle_ps::<0x44>(a, b), _mm512_shuffle_ps::<0xee>(a, b));
        let singles = |a, b| _mm512_add_ps(_mm512_shuffle_ps::<0x88>(a, b), _mm512_shuffle_ps::<0xdd>(a, b));
        let four = |q: usize| quarters(halves(r[q].0, r[4 + q].0), halves(r[8 + q].0, r[12 + q].0));
        Avx512(singles(pairs(four(0), four(1)), pairs(four(2), four(3))))
    }
}

/// An 8 x 8 transpose within registers of 256 bits.
#[inline(always)]
fn transpose_8x8(r: [__m256; 8]) -> [__m256; 8] {
    // SAFETY: see the module's page.
    unsafe {
        let mut t = r;
        for i in 0..2 {
            let (a, b, c, d) = (r[4 * i], r[4 * i + 1], r[4 * i + 2], r[4 * i + 3]);
            let (ab0, ab1) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
            let (cd0, cd1) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
            t[4 * i] = _mm256_shuffle_ps::<0x44>(ab0, cd0);
            t[4 * i + 1] = _mm256_shuffle_ps::<0xee>(ab0, cd0);
            t[4 * i + 2] = _mm256_shuffle_ps::<0x44>(ab1, cd1);
            t[4 * i + 3] = _mm256_shuffle_ps::<0xee>(ab1, cd1);
        }
        let low = |k: usize| _mm256_permute2f128_ps::<0x20>(t[k], t[4 + k]);
        let high = |k: usize| _mm256_permute2f128_ps::<0x31>(t[k], t[4 + k]);
        [low(0), low(1), low(2), low(3), high(0), high(1), high(2), high(3)]
    }
}

#[inline(always)]
fn transpose_avx2(r: &mut [Avx2; LANES]) {
    let quarter = |row: usize, half: usize| transpose_8x8(std::array::from_fn(|i| r[row + i].0[half]));
    let (a, b, c, d) = (quarter(0, 0), quarter(0, 1), quarter(8, 0), quarter(8, 1));
    for i in 0..8 {
        r[i] = Avx2([a[i], c[i]]);
        r[8 + i] = Avx2([b[i], d[i]]);
    }
}

/// As on AVX-512: a half of each row, then quarters, pairs and single numbers.
#[inline(always)]
fn row_sums_avx2(r: [Avx2; LANES]) -> Avx2 {
    // SAFETY: see the module's page.
    unsafe {
        let quarters = |a, b| _mm256_add_ps(_mm256_permute2f128_ps::<0x20>(a, b), _mm256_permute2f128_ps::<0x31>(a, b));
        let pairs = |a, b| _mm256_add_ps(_mm256_shuffle_ps::<0x44>(a, b), _mm256_shuffle_ps::<0xee>(a, b));
        let singles = |a, b| _mm256_add_ps(_mm256_shuffle_ps::<0x88>(a, b), _mm256_shuffle_ps::<0xdd>(a, b));
        let half = |row: usize| _mm256_add_ps(r[row].0[0], r[row].0[1]);
        let eight = |row: usize| {
            let two = |q: usize| quarters(half(row + q), half(row + 4 + q));
            singles(pairs(two(0), two(1)), pairs(two(2), two(3)))
        };
        Avx2([eight(0), eight(8)])
    }
}

macro_rules! lane {
    ($t:ty, $rows:literal x $blocks:literal, $load:expr, $store:expr, $transpose:expr, $row_sums:expr) => {
        impl Lane for $t {
            type Elem = f32;
            #[inline(always)]
            fn tiled<T: Tiled>(work: T) {
                work.run::<$rows, $blocks>()
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
                $load(p)
            }
            #[inline(always)]
            unsafe fn store(self, p: *mut f32) {
                $store(self, p)
            }
            #[inline(always)]
            fn transpose(rows: &mut [Self; LANES]) {
                $transpose(rows)
            }
            #[inline(always)]
            fn row_sums(rows: [Self; LANES]) -> Self {
                $row_sums(rows)
            }
        }
    };
}
// SAFETY (all closures): see the module's page, and the caller's promise about the pointer.
// 24 accumulators of 32 registers that hold a block each.
lane!(
    Avx512,
    6 x 4,
    |p| Avx512(unsafe { _mm512_loadu_ps(p) }),
    |s: Avx512, p| unsafe { _mm512_storeu_ps(p, s.0) },
    transpose_avx512,
    row_sums_avx512
);
// 12 accumulators of 16 registers that hold half a block each.
lane!(
    Avx2,
    3 x 2,
    |p: *const f32| Avx2(unsafe { [_mm256_loadu_ps(p), _mm256_loadu_ps(p.add(8))] }),
    |s: Avx2, p: *mut f32| unsafe {
        _mm256_storeu_ps(p, s.0[0]);
        _mm256_storeu_ps(p.add(8), s.0[1]);
    },
    transpose_avx2,
    row_sums_avx2
);

impl Lane32 for Avx512 {
    type Bits = Avx512Bits;
    #[inline(always)]
    fn from_bits(bits: Avx512Bits) -> Self {
        // SAFETY: see the module's page.
        Self(unsafe { _mm512_cvtepi32_ps(bits.0) })
    }
}
impl Lane32 for Avx2 {
    type Bits = Avx2Bits;
    #[inline(always)]
    fn from_bits(bits: Avx2Bits) -> Self {
        Self(pair!(_mm256_cvtepi32_ps, bits.0))
    }
}

impl Word for Avx512Bits {
    #[inline(always)]
    fn splat(x: u32) -> Self {
        // SAFETY: see the module's page.
        Self(unsafe { _mm512_set1_epi32(x as i32) })
    }
    #[inline(always)]
    fn mul_wide(self, x: u32) -> (Self, Self) {
        // The instruction multiplies the even lanes; the odd ones are shifted down for it.
        // SAFETY: see the module's page.
        unsafe {
            let x = _mm512_set1_epi32(x as i32);
            let even = _mm512_mul_epu32(self.0, x);
            let odd = _mm512_mul_epu32(_mm512_srli_epi64::<32>(self.0), x);
            // A shuffle of pairs under a mask moves and merges at once.
            let high = _mm512_mask_shuffle_epi32::<0xf5>(odd, 0x5555, even);
            let low = _mm512_mask_shuffle_epi32::<0xa0>(even, 0xaaaa, odd);
            (Self(high), Self(low))
        }
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        // SAFETY: see the module's page.
        Self(unsafe { _mm512_srli_epi32::<N>(self.0) })
    }
}
impl Bits for Avx512Bits {
    #[inline(always)]
    fn from_array(x: [u32; LANES]) -> Self {
        // SAFETY: the array has the length of a block.
        Self(unsafe { _mm512_loadu_si512(x.as_ptr().cast()) })
    }
    #[inline(always)]
    fn to_array(self) -> [u32; LANES] {
        let mut x = [0; LANES];
        // SAFETY: the array has the length of a block.
        unsafe { _mm512_storeu_si512(x.as_mut_ptr().cast(), self.0) };
        x
    }
}
impl Word for Avx2Bits {
    #[inline(always)]
    fn splat(x: u32) -> Self {
        // SAFETY: see the module's page.
        Self([unsafe { _mm256_set1_epi32(x as i32) }; 2])
    }
    #[inline(always)]
    fn mul_wide(self, x: u32) -> (Self, Self) {
        let half = |a| {
            // SAFETY: see the module's page.
            unsafe {
                let x = _mm256_set1_epi32(x as i32);
                let even = _mm256_mul_epu32(a, x);
                let odd = _mm256_mul_epu32(_mm256_srli_epi64::<32>(a), x);
                let high = _mm256_blend_epi32::<0xaa>(_mm256_srli_epi64::<32>(even), odd);
                let low = _mm256_blend_epi32::<0xaa>(even, _mm256_slli_epi64::<32>(odd));
                (high, low)
            }
        };
        let [a, b] = self.0.map(half);
        (Self([a.0, b.0]), Self([a.1, b.1]))
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        // SAFETY: see the module's page.
        let count = unsafe { _mm_cvtsi32_si128(N as i32) };
        Self(pair!(|a| _mm256_srl_epi32(a, count), self.0))
    }
}
impl Bits for Avx2Bits {
    #[inline(always)]
    fn from_array(x: [u32; LANES]) -> Self {
        // SAFETY: the array has the length of a block.
        Self(unsafe { [_mm256_loadu_si256(x.as_ptr().cast()), _mm256_loadu_si256(x.as_ptr().add(8).cast())] })
    }
    #[inline(always)]
    fn to_array(self) -> [u32; LANES] {
        let mut x = [0; LANES];
        // SAFETY: the array has the length of a block.
        unsafe {
            _mm256_storeu_si256(x.as_mut_ptr().cast(), self.0[0]);
            _mm256_storeu_si256(x.as_mut_ptr().add(8).cast(), self.0[1]);
        }
        x
    }
}
