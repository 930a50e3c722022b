//! The block in four registers of 128 bits, as every 64-bit Arm has them, with fused multiply-add: results are those of
//! AVX2 and AVX-512 bit for bit.

use crate::base::lane::LANES;
use crate::base::lane::block::{block, operations};
use std::arch::aarch64::*;

type R = float32x4_t;
type W = uint32x4_t;
type T = uint32x4_t;

// 24 accumulators of 32 registers that hold a quarter of a block each.
block!(
    Neon, NeonWords, NeonTruth, 4 registers, fuses: true, tile: 3 x 2,
    features: "neon"
);

operations! {
    splat(x: f32) -> R = vdupq_n_f32(x);
    load(p: *const f32) -> R = vld1q_f32(p);
    store(a: R, p: *mut f32) -> () = vst1q_f32(p, a);
    add(a: R, b: R) -> R = vaddq_f32(a, b);
    sub(a: R, b: R) -> R = vsubq_f32(a, b);
    mul(a: R, b: R) -> R = vmulq_f32(a, b);
    div(a: R, b: R) -> R = vdivq_f32(a, b);
    neg(a: R) -> R = vnegq_f32(a);
    mul_add(a: R, b: R, c: R) -> R = vfmaq_f32(c, a, b);
    sqrt(a: R) -> R = vsqrtq_f32(a);
    abs(a: R) -> R = vabsq_f32(a);
    // The instructions of these names answer NaN where either is; the second is wanted.
    min(a: R, b: R) -> R = vbslq_f32(vcltq_f32(a, b), a, b);
    max(a: R, b: R) -> R = vbslq_f32(vcgtq_f32(a, b), a, b);
    lt(a: R, b: R) -> T = vcltq_f32(a, b);
    le(a: R, b: R) -> T = vcleq_f32(a, b);
    select(mask: T, yes: R, no: R) -> R = vbslq_f32(mask, yes, no);
    round(a: R) -> R = vrndnq_f32(a);
    pow2(a: R) -> R = vreinterpretq_f32_s32(vshlq_n_s32::<23>(vaddq_s32(vcvtnq_s32_f32(a), vdupq_n_s32(127))));
    mantissa(a: R) -> R = vreinterpretq_f32_u32(vorrq_u32(
        vandq_u32(vreinterpretq_u32_f32(a), vdupq_n_u32(0x007f_ffff)),
        vdupq_n_u32(0x3f00_0000)
    ));
    exponent(a: R) -> R =
        vsubq_f32(vcvtq_f32_u32(vshrq_n_u32::<23>(vreinterpretq_u32_f32(a))), vdupq_n_f32(126.0));
    truth_and(a: T, b: T) -> T = vandq_u32(a, b);
    truth_or(a: T, b: T) -> T = vorrq_u32(a, b);
    truth_not(a: T) -> T = vmvnq_u32(a);
    each_bit() -> W = vld1q_u32([1, 2, 4, 8].as_ptr());
    truth_bits(a: T) -> u32 = vaddvq_u32(vandq_u32(a, each_bit()));
    truth_of(bits: u32) -> T = vtstq_u32(vdupq_n_u32(bits), each_bit());
    number(a: W) -> R = vcvtq_f32_s32(vreinterpretq_s32_u32(a));
    word_splat(x: u32) -> W = vdupq_n_u32(x);
    word_xor(a: W, b: W) -> W = veorq_u32(a, b);
    word_and(a: W, b: W) -> W = vandq_u32(a, b);
    shift_right<const N>(a: W) -> W = vshlq_u32(a, vdupq_n_s32(-(N as i32)));
    low_products(a: W, x: W) -> W = vreinterpretq_u32_u64(vmull_u32(vget_low_u32(a), vget_low_u32(x)));
    high_products(a: W, x: W) -> W = vreinterpretq_u32_u64(vmull_high_u32(a, x));
    mul_high(a: W, x: W) -> W = vuzp2q_u32(low_products(a, x), high_products(a, x));
    mul_low(a: W, x: W) -> W = vmulq_u32(a, x);
    // To bf16: half of the last place is added, or a bit less where it is even.
    odd_place(a: W) -> W = vandq_u32(vshrq_n_u32::<16>(a), vdupq_n_u32(1));
    near(a: W) -> W = vaddq_u32(vaddq_u32(a, vdupq_n_u32(0x7fff)), odd_place(a));
    first_half(a: R) -> W = vshrq_n_u32::<16>(near(vreinterpretq_u32_f32(a)));
    second_half(a: R) -> W = vandq_u32(near(vreinterpretq_u32_f32(a)), vdupq_n_u32(0xffff_0000));
    bf16_pairs(a: R, b: R) -> R = vreinterpretq_f32_u32(vorrq_u32(first_half(a), second_half(b)));
}

/// A 4 x 4 transpose within registers.
#[inline(always)]
fn transpose_4x4(r: [R; 4]) -> [R; 4] {
    // SAFETY: arithmetic in registers.
    unsafe {
        let even = |a, b| vreinterpretq_f64_f32(vtrn1q_f32(a, b));
        let odd = |a, b| vreinterpretq_f64_f32(vtrn2q_f32(a, b));
        let low = |a, b| vreinterpretq_f32_f64(vtrn1q_f64(a, b));
        let high = |a, b| vreinterpretq_f32_f64(vtrn2q_f64(a, b));
        let (ab0, ab1, cd0, cd1) = (even(r[0], r[1]), odd(r[0], r[1]), even(r[2], r[3]), odd(r[2], r[3]));
        [low(ab0, cd0), low(ab1, cd1), high(ab0, cd0), high(ab1, cd1)]
    }
}

#[inline(always)]
fn transpose(rows: &mut [Neon; LANES]) {
    let old = *rows;
    for down in 0..4 {
        for across in 0..4 {
            let r = transpose_4x4(std::array::from_fn(|i| old[4 * down + i].0[across]));
            (0..4).for_each(|i| rows[4 * across + i].0[down] = r[i]);
        }
    }
}

/// Quarters of each row, then pairs and single numbers, in the order of [`Lane::sum`].
#[inline(always)]
fn row_sums(r: [Neon; LANES]) -> Neon {
    // SAFETY: arithmetic in registers.
    unsafe {
        let quarter = |row: usize| {
            let [a, b, c, d] = r[row].0;
            add(add(a, c), add(b, d))
        };
        let lows = |a, b| vcombine_f32(vget_low_f32(a), vget_low_f32(b));
        let highs = |a, b| vcombine_f32(vget_high_f32(a), vget_high_f32(b));
        let pairs = |a, b| add(lows(a, b), highs(a, b));
        let four =
            |row: usize| vpaddq_f32(pairs(quarter(row), quarter(row + 1)), pairs(quarter(row + 2), quarter(row + 3)));
        Neon([four(0), four(4), four(8), four(12)])
    }
}
