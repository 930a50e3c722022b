//! The product of pairs of bf16 on 512-bit registers.

use crate::base::lane::{COLUMNS, LANES};
use std::arch::x86_64::*;

/// Rows of a tile, and registers of a row: 24 sums for 4 loads and 6 broadcasts.
const ROWS: usize = 6;
const BLOCKS: usize = COLUMNS / LANES;

pub fn exists() -> bool {
    super::has_avx512() && is_x86_feature_detected!("avx512bf16")
}

/// C = A B, as [`crate::base::lane::bf16::product`].
///
/// # Safety
/// The CPU has AVX-512 BF16; the matrices are as large as `rows` and `words` say.
#[target_feature(enable = "avx512f,avx512bf16")]
pub unsafe fn product(rows: usize, words: usize, a: *const u32, b: *const u32, c: *mut f32) {
    for row in (0..rows).step_by(ROWS) {
        // SAFETY: promised by the caller; tiles end at the last row.
        unsafe {
            let (a, c) = (a.add(row * words), c.add(row * COLUMNS));
            match rows - row {
                1 => tile::<1>(words, a, b, c),
                2 => tile::<2>(words, a, b, c),
                3 => tile::<3>(words, a, b, c),
                4 => tile::<4>(words, a, b, c),
                5 => tile::<5>(words, a, b, c),
                _ => tile::<ROWS>(words, a, b, c),
            }
        }
    }
}

/// The same bits under the name that the instruction's function wants.
#[inline(always)]
fn pairs(words: __m512i) -> __m512bh {
    // SAFETY: both are 512 bits, of which all values are valid.
    unsafe { std::mem::transmute::<__m512i, __m512bh>(words) }
}

#[target_feature(enable = "avx512f,avx512bf16")]
unsafe fn tile<const N: usize>(words: usize, a: *const u32, b: *const u32, c: *mut f32) {
    // SAFETY: promised by the caller.
    unsafe {
        let mut sums = [[_mm512_setzero_ps(); BLOCKS]; N];
        for k in 0..words {
            let mut right = [_mm512_setzero_si512(); BLOCKS];
            for (j, right) in right.iter_mut().enumerate() {
                *right = _mm512_loadu_si512(b.add(k * COLUMNS + LANES * j).cast());
            }
            for (i, row) in sums.iter_mut().enumerate() {
                let left = _mm512_set1_epi32(a.add(i * words + k).read() as i32);
                for (sum, right) in row.iter_mut().zip(right) {
                    *sum = _mm512_dpbf16_ps(*sum, pairs(left), pairs(right));
                }
            }
        }
        for (i, row) in sums.iter().enumerate() {
            for (j, sum) in row.iter().enumerate() {
                _mm512_storeu_ps(c.add(i * COLUMNS + LANES * j), *sum);
            }
        }
    }
}
