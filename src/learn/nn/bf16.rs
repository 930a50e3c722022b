//! The matrix product behind every layer with its factors rounded to bf16, and sums, activations and weights in single
//! precision.
//!
//! Factors are packed in pairs just before they are multiplied, in memory that stays in cache.

use super::HIDDEN;
use super::aligned::Aligned;
use super::gemm::{Broadcast, Exact, Finish, Precision, multiply_pairs};
use crate::base::lane::bf16::{Bf16Unit, product};
use crate::base::lane::{COLUMNS, LANES, Lane, Lane32, build};
use std::cell::RefCell;

/// Products with factors in bf16, on the best unit of this CPU.
pub struct Bf16;

/// Rows or inner numbers below which singles are faster: the heads.
const LEAST: usize = 16;

/// A, B in pairs and C of one product.
struct Packed {
    a: Aligned<u32>,
    b: Aligned<u32>,
    c: Aligned<f32>,
}

impl Packed {
    fn empty() -> Self {
        Packed { a: Aligned::zeros(0), b: Aligned::zeros(0), c: Aligned::zeros(0) }
    }

    /// Makes room; what was there is lost.
    fn reserve(&mut self, rows: usize, words: usize) {
        fn grow<E: Copy + Default>(of: &mut Aligned<E>, least: usize) {
            if of.len() < least {
                *of = Aligned::zeros(least);
            }
        }
        grow(&mut self.a, rows * words);
        grow(&mut self.b, words * COLUMNS);
        grow(&mut self.c, rows * COLUMNS);
    }
}

impl<L: Lane32> Precision<L> for Bf16 {
    #[inline(always)]
    fn multiply<F: Finish<L>>(rows: usize, inner: usize, a: Broadcast<f32>, b: &[f32], finish: F) {
        let in_blocks = if a.column == 1 { inner } else { rows };
        if rows < LEAST || inner < LEAST || !in_blocks.is_multiple_of(LANES) {
            return Exact::multiply::<F>(rows, inner, a, b, finish);
        }
        assert!(a.column == 1 || a.row == 1, "neighbours along one dimension");
        assert!(finish.rows() >= rows + F::SUMS as usize && b.len() >= inner * HIDDEN);
        assert!(a.data.len() > (rows - 1) * a.row + (inner - 1) * a.column);
        thread_local!(static PACKED: RefCell<Packed> = RefCell::new(Packed::empty()));
        PACKED.with_borrow_mut(|packed| {
            let (padded, words) = (rows.next_multiple_of(LANES), inner.div_ceil(2 * LANES) * LANES);
            packed.reserve(padded, words);
            let product = Bf16Product { rows, inner, words, a, b, packed, finish };
            // SAFETY: the matrices are as large as was asserted, and what is packed as was resized.
            if Bf16Unit::best() == Bf16Unit::Avx512 && L::has_dot() {
                L::vectorize_dot(
                    #[inline(always)]
                    || unsafe { product.run_in_registers::<L>() },
                );
            } else {
                L::vectorize(
                    #[inline(always)]
                    || unsafe { product.run::<L>() },
                );
            }
        });
    }
}

/// Words as the numbers of the same bits.
fn as_numbers(words: &[u32]) -> &[f32] {
    // SAFETY: as many, of the same size and alignment, and any bits are a number.
    unsafe { std::slice::from_raw_parts(words.as_ptr().cast(), words.len()) }
}

/// A finish without its row of sums.
struct Unsummed<'a, F>(&'a mut F);

impl<L: Lane, F: Finish<L>> Finish<L> for Unsummed<'_, F> {
    #[inline(always)]
    fn rows(&self) -> usize {
        self.0.rows()
    }
    #[inline(always)]
    unsafe fn start(&self, row: usize, block: usize) -> L {
        // SAFETY: promised by the caller.
        unsafe { self.0.start(row, block) }
    }
    #[inline(always)]
    unsafe fn end(&mut self, row: usize, block: usize, pair: [L; 2]) {
        // SAFETY: promised by the caller.
        unsafe { self.0.end(row, block, pair) }
    }
}

/// One product. Word `i` of 16 pairs inner numbers `i` and `16 + i` of 32, in A and in B: which are paired is the same
/// to a sum, and these lie in two blocks.
struct Bf16Product<'a, F> {
    rows: usize,
    inner: usize,
    words: usize,
    a: Broadcast<'a, f32>,
    b: &'a [f32],
    packed: &'a mut Packed,
    finish: F,
}

impl<F> Bf16Product<'_, F> {
    /// All of it in this block's registers.
    #[inline(always)]
    unsafe fn run_in_registers<L: Lane32>(mut self)
    where
        F: Finish<L>,
    {
        // SAFETY: promised by the caller, and what is packed is as large as its shape.
        unsafe {
            self.pack::<L, true>();
            // The last pairs of zeros are left out.
            let words = self.inner / (2 * LANES) * LANES + LANES.min(self.inner % (2 * LANES));
            let (a, b) = (as_numbers(&self.packed.a), as_numbers(&self.packed.b));
            let a = Broadcast { data: a, row: self.words, column: 1 };
            multiply_pairs::<L, _>(self.rows, words, a, b, Unsummed(&mut self.finish));
            self.sums::<L>();
        }
    }

    /// By a unit that leaves the product in memory.
    #[inline(always)]
    unsafe fn run<L: Lane32>(mut self)
    where
        F: Finish<L>,
    {
        // SAFETY: promised by the caller.
        unsafe {
            self.pack::<L, false>();
            let Packed { a, b, c } = &mut *self.packed;
            product(Bf16Unit::best(), self.rows.next_multiple_of(LANES), self.words, a, b, c);
            let c = self.packed.c.as_ptr();
            for row in 0..self.rows {
                for block in (0..HIDDEN / LANES).step_by(2) {
                    let product = |j: usize| L::load(c.add(row * COLUMNS + (block + j) * LANES));
                    let sums = build!(|j| self.finish.start(row, block + j) + product(j));
                    self.finish.end(row, block, sums);
                }
            }
            self.sums::<L>();
        }
    }

    #[inline(always)]
    unsafe fn pack<L: Lane32, const DOT: bool>(&mut self) {
        const { assert!(HIDDEN == COLUMNS) }
        // SAFETY: promised by the caller.
        unsafe {
            if self.a.column == 1 {
                self.pack_rows::<L, DOT>()
            } else {
                self.pack_columns::<L, DOT>()
            }
            self.pack_b::<L, DOT>();
        }
    }

    /// The row of sums of B's columns, in singles, if it is wanted.
    #[inline(always)]
    unsafe fn sums<L: Lane32>(&mut self)
    where
        F: Finish<L>,
    {
        if !F::SUMS {
            return;
        }
        for block in (0..HIDDEN / LANES).step_by(2) {
            // SAFETY: promised by the caller.
            unsafe {
                let mut sums: [L; 2] = build!(|j| self.finish.start(self.rows, block + j));
                for row in 0..self.inner {
                    let b = self.b.as_ptr().add(row * HIDDEN + block * LANES);
                    sums = build!(|j| sums[j] + L::load(b.add(j * LANES)));
                }
                self.finish.end(self.rows, block, sums);
            }
        }
    }

    /// Pairs of the block at `p` and the one so many numbers after it, or zeros.
    #[inline(always)]
    unsafe fn pair<L: Lane32, const DOT: bool>(p: *const f32, second: Option<usize>) -> L {
        // SAFETY: promised by the caller.
        let (first, second) = unsafe { (L::load(p), second.map_or(L::zero(), |second| L::load(p.add(second)))) };
        if DOT { L::dot_pairs(first, second) } else { L::bf16_pairs(first, second) }
    }

    #[inline(always)]
    unsafe fn pack_b<L: Lane32, const DOT: bool>(&mut self) {
        let (b, to) = (self.b.as_ptr(), self.packed.b.as_mut_ptr().cast::<f32>());
        for word in 0..self.words {
            let row = 2 * word - word % LANES;
            for block in (0..HIDDEN).step_by(LANES) {
                // SAFETY: promised by the caller.
                unsafe {
                    let to = to.add(word * COLUMNS + block);
                    if row < self.inner {
                        let second = (row + LANES < self.inner).then_some(LANES * HIDDEN);
                        Self::pair::<L, DOT>(b.add(row * HIDDEN + block), second).store(to);
                    } else {
                        L::zero().store(to);
                    }
                }
            }
        }
    }

    /// A whose neighbours along the inner dimension are neighbours in memory.
    #[inline(always)]
    unsafe fn pack_rows<L: Lane32, const DOT: bool>(&mut self) {
        let (a, to) = (self.a.data.as_ptr(), self.packed.a.as_mut_ptr().cast::<f32>());
        for row in 0..self.rows {
            for word in (0..self.words).step_by(LANES) {
                let second = (2 * word + LANES < self.inner).then_some(LANES);
                // SAFETY: promised by the caller.
                unsafe {
                    let from = a.add(row * self.a.row + 2 * word);
                    Self::pair::<L, DOT>(from, second).store(to.add(row * self.words + word));
                }
            }
        }
    }

    /// A whose rows are neighbours in memory: 16 rows of 16 pairs are packed side by side and transposed.
    #[inline(always)]
    unsafe fn pack_columns<L: Lane32, const DOT: bool>(&mut self) {
        let (a, to) = (self.a.data.as_ptr(), self.packed.a.as_mut_ptr().cast::<f32>());
        for row in (0..self.rows).step_by(LANES) {
            for word in (0..self.words).step_by(LANES) {
                // SAFETY: promised by the caller.
                unsafe {
                    let mut block: [L; LANES] = build!(|i| {
                        let first = 2 * word + i;
                        if first < self.inner {
                            let second = (first + LANES < self.inner).then_some(LANES * self.a.column);
                            Self::pair::<L, DOT>(a.add(first * self.a.column + row), second)
                        } else {
                            L::zero()
                        }
                    });
                    L::transpose(&mut block);
                    for (i, block) in block.iter().enumerate() {
                        block.store(to.add((row + i) * self.words + word));
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::lane::{Kernel, Level, Portable, dispatch};
    use crate::base::rng::{Philox, RngStream};
    use crate::learn::nn::finish::Accumulate;
    use rand::RngExt;

    /// Near the product in singles, as near as eight bits are, whatever the shape and the strides.
    #[test]
    fn is_near_the_product_in_singles() {
        let mut rng = Philox::new(3).sequence(RngStream::Weights, 0, 0);
        for (rows, inner) in [(64, 64), (47, 64), (64, 47), (16, 16), (64, 80), (1, 64), (64, 4)] {
            let a: Vec<f32> = (0..80 * 64).map(|_| rng.random_range(-1.0..1.0)).collect();
            let b: Vec<f32> = (0..80 * 64).map(|_| rng.random_range(-1.0..1.0)).collect();
            for (row, column) in [(inner, 1), (1, rows)] {
                let broadcast = || Broadcast { data: &a[..], row, column };
                let (mut near, mut exact) = (vec![0.5f32; 65 * 64], vec![0.5f32; 65 * 64]);
                type L = Portable<f32>;
                <Bf16 as Precision<L>>::multiply(rows, inner, broadcast(), &b, Accumulate::<_, true>(&mut near));
                <Exact as Precision<L>>::multiply(rows, inner, broadcast(), &b, Accumulate::<_, true>(&mut exact));
                let off = near.iter().zip(&exact).map(|(x, y)| (x - y).abs()).fold(0.0, f32::max);
                let most = 0.004 * (inner as f32).sqrt();
                assert!(
                    off < most
                        && (off > 0.0)
                            == (rows >= LEAST
                                && inner >= LEAST
                                && (if column == 1 { inner } else { rows }) % LANES == 0),
                    "{rows} x {inner}: {off}"
                );
            }
        }
    }

    struct Sums<'a>(usize, usize, Broadcast<'a, f32>, &'a [f32]);

    impl Kernel for Sums<'_> {
        type Output = Vec<f32>;
        #[inline(always)]
        fn run<L: Lane32>(self) -> Vec<f32> {
            let Sums(rows, inner, a, b) = self;
            let mut sums = vec![0.0; (rows + 1) * HIDDEN];
            <Bf16 as Precision<L>>::multiply(rows, inner, a, b, Accumulate::<_, true>(&mut sums));
            sums
        }
    }

    /// What stays in registers has the same bits on each block where the sum begins with zero.
    #[test]
    fn every_block_multiplies_alike() {
        let mut rng = Philox::new(4).sequence(RngStream::Weights, 0, 0);
        let by_row = [(64, 64), (47, 64), (16, 16), (64, 80)].map(|(rows, inner)| (rows, inner, inner, 1));
        let by_column = [(64, 64), (64, 41), (16, 16), (48, 80)].map(|(rows, inner)| (rows, inner, 1, rows));
        for (rows, inner, row, column) in by_row.into_iter().chain(by_column) {
            let a: Vec<f32> = (0..80 * 64).map(|_| rng.random_range(-1.0..1.0)).collect();
            let b: Vec<f32> = (0..80 * 64).map(|_| rng.random_range(-1.0..1.0)).collect();
            let of = |level| dispatch(level, Sums(rows, inner, Broadcast { data: &a, row, column }, &b));
            let wanted = of(Level::Portable);
            for level in Level::available() {
                assert!(of(level) == wanted, "{rows} x {inner}, {level}");
            }
        }
    }
}
