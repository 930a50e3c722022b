//! The block in four registers of 128 bits, which every x86-64 has: what runs where AVX2 is not. Multiply-add is not
//! fused.

use crate::base::lane::LANES;
use crate::base::lane::block::{block, operations};
use std::arch::x86_64::*;

type R = __m128;
type W = __m128i;
type T = __m128;

// 8 accumulators of 16 registers that hold a quarter of a block each.
block!(
    Sse2, Sse2Words, Sse2Truth, 4 registers, fuses: false, tile: 1 x 2,
    features: "sse2"
);

operations! {
    splat(x: f32) -> R = _mm_set1_ps(x);
    load(p: *const f32) -> R = _mm_loadu_ps(p);
    store(a: R, p: *mut f32) -> () = _mm_storeu_ps(p, a);
    add(a: R, b: R) -> R = _mm_add_ps(a, b);
    sub(a: R, b: R) -> R = _mm_sub_ps(a, b);
    mul(a: R, b: R) -> R = _mm_mul_ps(a, b);
    div(a: R, b: R) -> R = _mm_div_ps(a, b);
    neg(a: R) -> R = _mm_xor_ps(a, _mm_set1_ps(-0.0));
    mul_add(a: R, b: R, c: R) -> R = _mm_add_ps(_mm_mul_ps(a, b), c);
    sqrt(a: R) -> R = _mm_sqrt_ps(a);
    abs(a: R) -> R = _mm_andnot_ps(_mm_set1_ps(-0.0), a);
    min(a: R, b: R) -> R = _mm_min_ps(a, b);
    max(a: R, b: R) -> R = _mm_max_ps(a, b);
    lt(a: R, b: R) -> T = _mm_cmplt_ps(a, b);
    le(a: R, b: R) -> T = _mm_cmple_ps(a, b);
    select(mask: T, yes: R, no: R) -> R = _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
    // Adding and taking away 1.5 * 2^23 rounds to even; what is larger than 2^22 has next to nothing after the point.
    rounded(a: R, magic: R) -> R = _mm_sub_ps(_mm_add_ps(a, magic), magic);
    round(a: R) -> R = select(lt(abs(a), splat(4_194_304.0)), rounded(a, splat(12_582_912.0)), a);
    pow2(a: R) -> R =
        _mm_castsi128_ps(_mm_slli_epi32::<23>(_mm_add_epi32(_mm_cvtps_epi32(a), _mm_set1_epi32(127))));
    mantissa(a: R) -> R = _mm_or_ps(
        _mm_and_ps(a, _mm_castsi128_ps(_mm_set1_epi32(0x007f_ffff))),
        _mm_castsi128_ps(_mm_set1_epi32(0x3f00_0000))
    );
    exponent(a: R) -> R =
        _mm_sub_ps(_mm_cvtepi32_ps(_mm_srli_epi32::<23>(_mm_castps_si128(a))), _mm_set1_ps(126.0));
    truth_and(a: T, b: T) -> T = _mm_and_ps(a, b);
    truth_or(a: T, b: T) -> T = _mm_or_ps(a, b);
    truth_not(a: T) -> T = _mm_xor_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-1)));
    truth_bits(a: T) -> u32 = _mm_movemask_ps(a) as u32;
    each_bit() -> W = _mm_setr_epi32(1, 2, 4, 8);
    truth_of(bits: u32) -> T =
        _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(word_splat(bits), each_bit()), each_bit()));
    number(a: W) -> R = _mm_cvtepi32_ps(a);
    word_splat(x: u32) -> W = _mm_set1_epi32(x as i32);
    word_xor(a: W, b: W) -> W = _mm_xor_si128(a, b);
    word_and(a: W, b: W) -> W = _mm_and_si128(a, b);
    shift_right<const N>(a: W) -> W = _mm_srl_epi32(a, _mm_cvtsi32_si128(N as i32));
    // The instruction multiplies the even lanes; the odd ones are shifted down for it.
    even(a: W, x: W) -> W = _mm_mul_epu32(a, x);
    odd(a: W, x: W) -> W = _mm_mul_epu32(_mm_srli_epi64::<32>(a), x);
    upper() -> W = _mm_set1_epi64x(0xffff_ffff_0000_0000_u64 as i64);
    mul_high(a: W, x: W) -> W = _mm_or_si128(_mm_srli_epi64::<32>(even(a, x)), _mm_and_si128(odd(a, x), upper()));
    mul_low(a: W, x: W) -> W = _mm_or_si128(_mm_andnot_si128(upper(), even(a, x)), _mm_slli_epi64::<32>(odd(a, x)));
    // To bf16: half of the last place is added, or a bit less where it is even.
    odd_place(a: W) -> W = _mm_and_si128(_mm_srli_epi32::<16>(a), _mm_set1_epi32(1));
    near(a: W) -> W = _mm_add_epi32(_mm_add_epi32(a, _mm_set1_epi32(0x7fff)), odd_place(a));
    first_half(a: R) -> W = _mm_srli_epi32::<16>(near(_mm_castps_si128(a)));
    second_half(a: R) -> W = _mm_and_si128(near(_mm_castps_si128(a)), _mm_set1_epi32(-0x10000));
    bf16_pairs(a: R, b: R) -> R = _mm_castsi128_ps(_mm_or_si128(first_half(a), second_half(b)));
}

#[inline(always)]
fn transpose(rows: &mut [Sse2; LANES]) {
    let old = *rows;
    for down in 0..4 {
        for across in 0..4 {
            let mut r: [R; 4] = std::array::from_fn(|i| old[4 * down + i].0[across]);
            let [a, b, c, d] = &mut r;
            // SAFETY: arithmetic in registers.
            unsafe { _MM_TRANSPOSE4_PS(a, b, c, d) };
            (0..4).for_each(|i| rows[4 * across + i].0[down] = r[i]);
        }
    }
}

/// Quarters of each row, then pairs and single numbers, in the order of [`Lane::sum`].
#[inline(always)]
fn row_sums(r: [Sse2; LANES]) -> Sse2 {
    // SAFETY: arithmetic in registers.
    unsafe {
        let quarter = |row: usize| {
            let [a, b, c, d] = r[row].0;
            add(add(a, c), add(b, d))
        };
        let pairs = |a, b| add(_mm_movelh_ps(a, b), _mm_movehl_ps(b, a));
        let singles = |a, b| add(_mm_shuffle_ps::<0x88>(a, b), _mm_shuffle_ps::<0xdd>(a, b));
        let four =
            |row: usize| singles(pairs(quarter(row), quarter(row + 1)), pairs(quarter(row + 2), quarter(row + 3)));
        Sse2([four(0), four(4), four(8), four(12)])
    }
}
