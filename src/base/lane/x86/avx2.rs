//! The block in two registers of 256 bits.

use crate::base::lane::LANES;
use crate::base::lane::block::{block, operations};
use std::arch::x86_64::*;

type R = __m256;
type W = __m256i;
type T = __m256;

// 12 accumulators of 16 registers that hold half a block each.
block!(
    Avx2, Avx2Words, Avx2Truth, 2 registers, fuses: true, tile: 3 x 2,
    features: "avx2,fma"
);

operations! {
    splat(x: f32) -> R = _mm256_set1_ps(x);
    load(p: *const f32) -> R = _mm256_loadu_ps(p);
    store(a: R, p: *mut f32) -> () = _mm256_storeu_ps(p, a);
    add(a: R, b: R) -> R = _mm256_add_ps(a, b);
    sub(a: R, b: R) -> R = _mm256_sub_ps(a, b);
    mul(a: R, b: R) -> R = _mm256_mul_ps(a, b);
    div(a: R, b: R) -> R = _mm256_div_ps(a, b);
    neg(a: R) -> R = _mm256_xor_ps(a, _mm256_set1_ps(-0.0));
    mul_add(a: R, b: R, c: R) -> R = _mm256_fmadd_ps(a, b, c);
    sqrt(a: R) -> R = _mm256_sqrt_ps(a);
    abs(a: R) -> R = _mm256_andnot_ps(_mm256_set1_ps(-0.0), a);
    min(a: R, b: R) -> R = _mm256_min_ps(a, b);
    max(a: R, b: R) -> R = _mm256_max_ps(a, b);
    lt(a: R, b: R) -> T = _mm256_cmp_ps::<_CMP_LT_OQ>(a, b);
    le(a: R, b: R) -> T = _mm256_cmp_ps::<_CMP_LE_OQ>(a, b);
    select(mask: T, yes: R, no: R) -> R = _mm256_blendv_ps(no, yes, mask);
    round(a: R) -> R = _mm256_round_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(a);
    pow2(a: R) -> R =
        _mm256_castsi256_ps(_mm256_slli_epi32::<23>(_mm256_add_epi32(_mm256_cvtps_epi32(a), _mm256_set1_epi32(127))));
    mantissa(a: R) -> R = _mm256_or_ps(
        _mm256_and_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(0x007f_ffff))),
        _mm256_castsi256_ps(_mm256_set1_epi32(0x3f00_0000))
    );
    exponent(a: R) -> R = _mm256_sub_ps(
        _mm256_cvtepi32_ps(_mm256_srli_epi32::<23>(_mm256_castps_si256(a))),
        _mm256_set1_ps(126.0)
    );
    truth_and(a: T, b: T) -> T = _mm256_and_ps(a, b);
    truth_or(a: T, b: T) -> T = _mm256_or_ps(a, b);
    truth_not(a: T) -> T = _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1)));
    truth_bits(a: T) -> u32 = _mm256_movemask_ps(a) as u32;
    each_bit() -> W = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    truth_of(bits: u32) -> T =
        _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(word_splat(bits), each_bit()), each_bit()));
    number(a: W) -> R = _mm256_cvtepi32_ps(a);
    word_splat(x: u32) -> W = _mm256_set1_epi32(x as i32);
    word_xor(a: W, b: W) -> W = _mm256_xor_si256(a, b);
    word_and(a: W, b: W) -> W = _mm256_and_si256(a, b);
    shift_right<const N>(a: W) -> W = _mm256_srl_epi32(a, _mm_cvtsi32_si128(N as i32));
    // The instruction multiplies the even lanes; the odd ones are shifted down for it.
    even(a: W, x: W) -> W = _mm256_mul_epu32(a, x);
    odd(a: W, x: W) -> W = _mm256_mul_epu32(_mm256_srli_epi64::<32>(a), x);
    mul_high(a: W, x: W) -> W = _mm256_blend_epi32::<0xaa>(_mm256_srli_epi64::<32>(even(a, x)), odd(a, x));
    mul_low(a: W, x: W) -> W = _mm256_blend_epi32::<0xaa>(even(a, x), _mm256_slli_epi64::<32>(odd(a, x)));
    // To bf16: half of the last place is added, or a bit less where it is even.
    odd_place(a: W) -> W = _mm256_and_si256(_mm256_srli_epi32::<16>(a), _mm256_set1_epi32(1));
    near(a: W) -> W = _mm256_add_epi32(_mm256_add_epi32(a, _mm256_set1_epi32(0x7fff)), odd_place(a));
    first_half(a: R) -> W = _mm256_srli_epi32::<16>(near(_mm256_castps_si256(a)));
    second_half(a: R) -> W = _mm256_and_si256(near(_mm256_castps_si256(a)), _mm256_set1_epi32(-0x10000));
    bf16_pairs(a: R, b: R) -> R = _mm256_castsi256_ps(_mm256_or_si256(first_half(a), second_half(b)));
}

/// An 8 x 8 transpose within registers.
#[inline(always)]
fn transpose_8x8(r: [__m256; 8]) -> [__m256; 8] {
    // SAFETY: see `lane/block.rs`.
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
fn transpose(r: &mut [Avx2; LANES]) {
    let quarter = |row: usize, half: usize| transpose_8x8(std::array::from_fn(|i| r[row + i].0[half]));
    let (a, b, c, d) = (quarter(0, 0), quarter(0, 1), quarter(8, 0), quarter(8, 1));
    for i in 0..8 {
        r[i] = Avx2([a[i], c[i]]);
        r[8 + i] = Avx2([b[i], d[i]]);
    }
}

/// Half of each row, then quarters, pairs and single numbers, in the order of [`Lane::sum`].
#[inline(always)]
fn row_sums(r: [Avx2; LANES]) -> Avx2 {
    // SAFETY: see `lane/block.rs`.
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
