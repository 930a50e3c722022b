//! The block in one register of 512 bits.

use crate::base::lane::LANES;
use crate::base::lane::block::{block, operations};
use std::arch::x86_64::*;

type R = __m512;
type W = __m512i;
type T = __mmask16;

// 24 accumulators of 32 registers that hold a block each.
block!(
    Avx512, Avx512Words, Avx512Truth, 1 registers, fuses: true, tile: 6 x 4,
    features: "avx512f,avx512dq,avx2,fma", dot: "avx512bw,avx512bf16" if super::has_avx512_bf16
);

/// Words 0 and 16, 1 and 17, ...
const ALTERNATING: [u32; LANES] = {
    let (mut words, mut i) = ([0; LANES], 0);
    while i < LANES {
        words[i] = (i | (i + LANES) << 16) as u32;
        i += 1;
    }
    words
};

operations! {
    splat(x: f32) -> R = _mm512_set1_ps(x);
    load(p: *const f32) -> R = _mm512_loadu_ps(p);
    store(a: R, p: *mut f32) -> () = _mm512_storeu_ps(p, a);
    add(a: R, b: R) -> R = _mm512_add_ps(a, b);
    sub(a: R, b: R) -> R = _mm512_sub_ps(a, b);
    mul(a: R, b: R) -> R = _mm512_mul_ps(a, b);
    div(a: R, b: R) -> R = _mm512_div_ps(a, b);
    neg(a: R) -> R = _mm512_xor_ps(a, _mm512_set1_ps(-0.0));
    mul_add(a: R, b: R, c: R) -> R = _mm512_fmadd_ps(a, b, c);
    sqrt(a: R) -> R = _mm512_sqrt_ps(a);
    abs(a: R) -> R = _mm512_abs_ps(a);
    min(a: R, b: R) -> R = _mm512_min_ps(a, b);
    max(a: R, b: R) -> R = _mm512_max_ps(a, b);
    lt(a: R, b: R) -> T = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b);
    le(a: R, b: R) -> T = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b);
    select(mask: T, yes: R, no: R) -> R = _mm512_mask_blend_ps(mask, no, yes);
    round(a: R) -> R = _mm512_roundscale_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(a);
    pow2(a: R) -> R = _mm512_scalef_ps(_mm512_set1_ps(1.0), a);
    mantissa(a: R) -> R = _mm512_getmant_ps::<_MM_MANT_NORM_P5_1, _MM_MANT_SIGN_SRC>(a);
    exponent(a: R) -> R = _mm512_add_ps(_mm512_getexp_ps(a), _mm512_set1_ps(1.0));
    truth_and(a: T, b: T) -> T = a & b;
    truth_or(a: T, b: T) -> T = a | b;
    truth_not(a: T) -> T = !a;
    truth_bits(a: T) -> u32 = a as u32;
    truth_of(bits: u32) -> T = bits as u16;
    number(a: W) -> R = _mm512_cvtepi32_ps(a);
    word_splat(x: u32) -> W = _mm512_set1_epi32(x as i32);
    word_xor(a: W, b: W) -> W = _mm512_xor_si512(a, b);
    word_and(a: W, b: W) -> W = _mm512_and_si512(a, b);
    shift_right<const N>(a: W) -> W = _mm512_srli_epi32::<N>(a);
    // The instruction multiplies the even lanes; the odd ones are shifted down for it.
    even(a: W, x: W) -> W = _mm512_mul_epu32(a, x);
    odd(a: W, x: W) -> W = _mm512_mul_epu32(_mm512_srli_epi64::<32>(a), x);
    // A shuffle of pairs under a mask moves and merges at once.
    mul_high(a: W, x: W) -> W = _mm512_mask_shuffle_epi32::<0xf5>(odd(a, x), 0x5555, even(a, x));
    mul_low(a: W, x: W) -> W = _mm512_mask_shuffle_epi32::<0xa0>(even(a, x), 0xaaaa, odd(a, x));
    // To bf16: half of the last place is added, or a bit less where it is even.
    odd_place(a: W) -> W = _mm512_and_si512(_mm512_srli_epi32::<16>(a), _mm512_set1_epi32(1));
    near(a: W) -> W = _mm512_add_epi32(_mm512_add_epi32(a, _mm512_set1_epi32(0x7fff)), odd_place(a));
    first_half(a: R) -> W = _mm512_srli_epi32::<16>(near(_mm512_castps_si512(a)));
    second_half(a: R) -> W = _mm512_and_si512(near(_mm512_castps_si512(a)), _mm512_set1_epi32(-0x10000));
    bf16_pairs(a: R, b: R) -> R = _mm512_castsi512_ps(_mm512_or_si512(first_half(a), second_half(b)));
    halves(a: R) -> __m512bh = std::mem::transmute::<R, __m512bh>(a);
    dot(sum: R, a: R, b: R) -> R = _mm512_dpbf16_ps(sum, halves(a), halves(b));
    // The conversion puts all of `a` before all of `b`.
    both(a: R, b: R) -> W = std::mem::transmute::<__m512bh, W>(_mm512_cvtne2ps_pbh(b, a));
    dot_pairs(a: R, b: R) -> R = _mm512_castsi512_ps(_mm512_permutexvar_epi16(alternating(), both(a, b)));
    alternating() -> W = _mm512_loadu_si512(ALTERNATING.as_ptr().cast());
}

/// Transposing through memory, 16 stores and 256 scalar moves, would be slow: registers are unpacked.
#[inline(always)]
fn transpose(r: &mut [Avx512; LANES]) {
    // SAFETY: see `lane/block.rs`.
    unsafe {
        let mut t = [_mm512_setzero_ps(); LANES];
        for i in 0..4 {
            let (a, b, c, d) = (r[4 * i].0[0], r[4 * i + 1].0[0], r[4 * i + 2].0[0], r[4 * i + 3].0[0]);
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
            r[k].0[0] = _mm512_shuffle_f32x4::<0x88>(ab0, cd0);
            r[8 + k].0[0] = _mm512_shuffle_f32x4::<0xdd>(ab0, cd0);
            r[4 + k].0[0] = _mm512_shuffle_f32x4::<0x88>(ab1, cd1);
            r[12 + k].0[0] = _mm512_shuffle_f32x4::<0xdd>(ab1, cd1);
        }
    }
}

/// Halves of two rows are added at a time, in the order of [`Lane::sum`]: 30 shuffles where a transpose takes 64.
#[inline(always)]
fn row_sums(r: [Avx512; LANES]) -> Avx512 {
    // SAFETY: see `lane/block.rs`.
    unsafe {
        let halves = |a, b| _mm512_add_ps(_mm512_shuffle_f32x4::<0x44>(a, b), _mm512_shuffle_f32x4::<0xee>(a, b));
        let quarters = |a, b| _mm512_add_ps(_mm512_shuffle_f32x4::<0x88>(a, b), _mm512_shuffle_f32x4::<0xdd>(a, b));
        let pairs = |a, b| _mm512_add_ps(_mm512_shuffle_ps::<0x44>(a, b), _mm512_shuffle_ps::<0xee>(a, b));
        let singles = |a, b| _mm512_add_ps(_mm512_shuffle_ps::<0x88>(a, b), _mm512_shuffle_ps::<0xdd>(a, b));
        let row = |i: usize| r[i].0[0];
        let four = |q: usize| quarters(halves(row(q), row(4 + q)), halves(row(8 + q), row(12 + q)));
        Avx512([singles(pairs(four(0), four(1)), pairs(four(2), four(3)))])
    }
}
