//! Products of matrices in bf16, the upper half of a single: pairs of them are multiplied and summed in single
//! precision, two and more times as fast as singles where the CPU has an instruction for it.
//!
//! A word holds two neighbours along the inner dimension, the first in its lower half. The units round alike but sum in
//! orders of their own, so that their last bits differ; one unit gives the same bits on any number of threads.

#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
use super::x86::amx;
#[cfg(target_arch = "x86_64")]
use super::x86::has_avx512_bf16;
use super::{COLUMNS, LANES};
use std::fmt;
use std::sync::OnceLock;

/// What multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bf16Unit {
    /// Tiles of 16 x 32 by 32 x 16 (Intel, Sapphire Rapids and later).
    Amx,
    /// `VDPBF16PS` on 512-bit registers (AMD Zen 4 and later; on Intel slower than singles).
    Avx512,
    /// The arithmetic of `VDPBF16PS`, number by number: for any CPU, and slow.
    Portable,
}

impl Bf16Unit {
    /// All that this CPU and its operating system have, best first.
    pub fn available() -> &'static [Bf16Unit] {
        static ALL: OnceLock<Vec<Bf16Unit>> = OnceLock::new();
        let all = [Bf16Unit::Amx, Bf16Unit::Avx512, Bf16Unit::Portable];
        ALL.get_or_init(|| all.into_iter().filter(|unit| unit.is_available()).collect())
    }

    /// The best of them.
    pub fn best() -> Bf16Unit {
        Bf16Unit::available()[0]
    }

    fn is_available(self) -> bool {
        match self {
            #[cfg(all(target_arch = "x86_64", target_os = "linux"))]
            Bf16Unit::Amx => amx::permitted(),
            #[cfg(target_arch = "x86_64")]
            Bf16Unit::Avx512 => has_avx512_bf16(),
            Bf16Unit::Portable => true,
            #[allow(unreachable_patterns)] // on other CPUs
            _ => false,
        }
    }
}

impl fmt::Display for Bf16Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Bf16Unit::Amx => "AMX",
            Bf16Unit::Avx512 => "AVX-512 BF16",
            Bf16Unit::Portable => "portable",
        })
    }
}

/// Two numbers rounded to the nearest bf16, ties to even, in one word: `first` in the lower half. The NaN that
/// arithmetic makes stays NaN.
#[inline(always)]
pub fn pair(first: f32, second: f32) -> u32 {
    rounded(first) >> 16 | rounded(second) & 0xffff_0000
}

#[inline(always)]
fn rounded(x: f32) -> u32 {
    let bits = x.to_bits();
    bits.wrapping_add(0x7fff + (bits >> 16 & 1))
}

/// C[rows][64] = A[rows][words] B[words][64], where a word is a pair: `rows` and `words` are multiples of [`LANES`].
/// Here `Avx512` is the same bits number by number; its instruction works in registers ([`super::Lane32::dot`]).
///
/// # Panics
/// If they are not, a matrix is too small, or the CPU does not have `unit`.
pub fn product(unit: Bf16Unit, rows: usize, words: usize, a: &[u32], b: &[u32], c: &mut [f32]) {
    assert!(rows.is_multiple_of(LANES) && words.is_multiple_of(LANES) && words > 0);
    assert!(a.len() >= rows * words && b.len() >= words * COLUMNS && c.len() >= rows * COLUMNS);
    assert!(Bf16Unit::available().contains(&unit), "this CPU does not have {unit}");
    match unit {
        // SAFETY: the CPU has the unit, and the matrices are as large as they say.
        #[cfg(all(target_arch = "x86_64", target_os = "linux"))]
        Bf16Unit::Amx => unsafe { amx::product(rows, words, a.as_ptr(), b.as_ptr(), c.as_mut_ptr()) },
        _ => portable(words, a, b, &mut c[..rows * COLUMNS]),
    }
}

fn portable(words: usize, a: &[u32], b: &[u32], c: &mut [f32]) {
    c.fill(0.0);
    for (a, c) in a.chunks_exact(words).zip(c.chunks_exact_mut(COLUMNS)) {
        for (&a, b) in a.iter().zip(b.chunks_exact(COLUMNS)) {
            c.iter_mut().zip(b).for_each(|(c, &b)| *c = dot(*c, a, b));
        }
    }
}

/// `sum` and the products of two pairs, the second first, as the instruction does: each sum is rounded once, and what
/// is below the normal numbers is zero.
fn dot(sum: f32, a: u32, b: u32) -> f32 {
    let flushed = |x: f32| if x.is_subnormal() { 0.0f32.copysign(x) } else { x };
    let second = |x: u32| flushed(f32::from_bits(x & 0xffff_0000));
    let first = |x: u32| flushed(f32::from_bits(x << 16));
    let sum = flushed(second(a).mul_add(second(b), flushed(sum)));
    flushed(first(a).mul_add(first(b), sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::lane::{Kernel, Lane32, Level, dispatch};
    use crate::base::rng::{Philox, RngStream};
    use rand::{Rng, RngExt};

    fn numbers(n: usize, rng: &mut impl Rng) -> Vec<f32> {
        (0..n).map(|_| rng.random_range(-2.0f32..2.0)).collect()
    }

    fn words(x: &[f32]) -> Vec<u32> {
        x.chunks_exact(2).map(|x| pair(x[0], x[1])).collect()
    }

    #[test]
    fn rounds_to_the_nearest_and_ties_to_even() {
        let half = |x: f32| f32::from_bits(pair(x, 0.0) << 16);
        assert_eq!(half(1.0 + 2f32.powi(-8)), 1.0);
        assert_eq!(half(1.0 + 3.0 * 2f32.powi(-8)), 1.0 + 2f32.powi(-6));
        assert_eq!(half(1.0 + 1.001 * 2f32.powi(-8)), 1.0 + 2f32.powi(-7));
        assert_eq!(half(-3.0), -3.0);
        assert_eq!(half(f32::MAX), f32::INFINITY);
        assert!(half(f32::NAN).is_nan() && half(-f32::NAN).is_nan());
        assert_eq!(pair(1.0, 2.0), 0x4000_3f80);
    }

    struct Pairs<'a>(&'a [f32; LANES], &'a [f32; LANES]);

    impl Kernel for Pairs<'_> {
        type Output = [u32; LANES];
        #[inline(always)]
        fn run<L: Lane32>(self) -> [u32; LANES] {
            L::bf16_pairs(L::from_array(*self.0), L::from_array(*self.1)).to_array().map(f32::to_bits)
        }
    }

    #[test]
    fn every_block_rounds_alike() {
        let mut rng = Philox::new(2).sequence(RngStream::Weights, 0, 0);
        for _ in 0..1000 {
            // Any bits but those of a NaN.
            let mut any = || {
                let x = f32::from_bits(rng.random());
                if x.is_nan() { 0.0 } else { x }
            };
            let [a, b]: [[f32; LANES]; 2] = std::array::from_fn(|_| std::array::from_fn(|_| any()));
            let wanted: [u32; LANES] = std::array::from_fn(|i| pair(a[i], b[i]));
            for level in Level::available() {
                assert_eq!(dispatch(level, Pairs(&a, &b)), wanted, "{level}");
            }
        }
    }

    /// A sum and the two factors' first and second numbers.
    struct Dot<'a>([&'a [f32; LANES]; 5]);

    impl Kernel for Dot<'_> {
        type Output = Option<[f32; LANES]>;
        #[inline(always)]
        fn run<L: Lane32>(self) -> Self::Output {
            let [sum, a, b, c, d] = self.0.map(|x| L::from_array(*x));
            L::has_dot().then(|| {
                L::vectorize_dot(
                    #[inline(always)]
                    || sum.dot(L::dot_pairs(a, b), L::dot_pairs(c, d)).to_array(),
                )
            })
        }
    }

    /// Where the CPU has the instruction, whether or not it is the best unit there.
    #[test]
    fn the_instruction_is_its_definition() {
        let mut rng = Philox::new(3).sequence(RngStream::Weights, 0, 0);
        for _ in 0..1000 {
            let x: [[f32; LANES]; 5] = std::array::from_fn(|_| numbers(LANES, &mut rng).try_into().unwrap());
            let wanted: [f32; LANES] =
                std::array::from_fn(|i| dot(x[0][i], pair(x[1][i], x[2][i]), pair(x[3][i], x[4][i])));
            for level in Level::available() {
                assert!(dispatch(level, Dot(x.each_ref())).is_none_or(|sums| sums == wanted), "{level}");
            }
        }
    }

    #[test]
    fn every_unit_multiplies() {
        let mut rng = Philox::new(1).sequence(RngStream::Weights, 0, 0);
        for (rows, inner) in [(16, 32), (64, 64), (112, 96)] {
            let (a, b) = (words(&numbers(rows * inner, &mut rng)), words(&numbers(inner * COLUMNS, &mut rng)));
            let value = |w: u32, k: usize| f64::from(f32::from_bits(if k == 0 { w << 16 } else { w & 0xffff_0000 }));
            let mut wanted = vec![0.0; rows * COLUMNS];
            for (i, wanted) in wanted.iter_mut().enumerate() {
                for w in 0..inner / 2 {
                    let (a, b) = (a[i / COLUMNS * inner / 2 + w], b[w * COLUMNS + i % COLUMNS]);
                    *wanted += value(a, 0) * value(b, 0) + value(a, 1) * value(b, 1);
                }
            }
            let of = |unit| {
                let mut c = vec![f32::NAN; rows * COLUMNS];
                product(unit, rows, inner / 2, &a, &b, &mut c);
                c
            };
            for &unit in Bf16Unit::available() {
                let off = of(unit).iter().zip(&wanted).map(|(c, w)| (f64::from(*c) - w).abs()).fold(0.0, f64::max);
                assert!(off < 2e-4, "{unit}: off by {off}");
            }
        }
    }
}
