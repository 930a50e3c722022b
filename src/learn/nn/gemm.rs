//! The one matrix product behind every layer, forward and backward: C = A B with B and C in rows of 64, A read by
//! broadcast.
//!
//! A tile of C stays in registers over the whole inner dimension: on AVX-512 24 accumulators for 4 loads and 6
//! broadcasts an inner step, so that the two multiply-add ports never wait for memory. What a tile starts as and what
//! becomes of it while it is still in registers is a [`Finish`].

use super::HIDDEN;
use crate::base::lane::{LANES, Lane, Lane32, Tiled, build};
use std::marker::PhantomData;

/// Blocks of a row of B and C.
const BLOCKS: usize = HIDDEN / LANES;

/// A matrix read number by number, at any stride.
#[derive(Clone, Copy)]
pub struct Broadcast<'a, E> {
    pub data: &'a [E],
    /// Distance of neighbouring rows, and of neighbours along the inner dimension.
    pub row: usize,
    pub column: usize,
}

/// How a tile of C begins, and where it goes.
pub trait Finish<L: Lane> {
    /// Whether C has a last row of its own, the column sums of B: the gradient by the biases, whose input is always 1.
    const SUMS: bool = false;

    /// Rows of C that there is room for.
    fn rows(&self) -> usize;
    /// What the product is added to.
    ///
    /// # Safety
    /// `row` is below [`Finish::rows`] and `block` below 4.
    unsafe fn start(&self, row: usize, block: usize) -> L;
    /// Takes blocks `block` and `block + 1` of a row.
    ///
    /// # Safety
    /// `row` is below [`Finish::rows`] and `block` below 3.
    unsafe fn end(&mut self, row: usize, block: usize, pair: [L; 2]);
}

/// How exactly products are taken.
pub trait Precision<L: Lane> {
    /// As [`multiply`].
    fn multiply<F: Finish<L>>(rows: usize, inner: usize, a: Broadcast<L::Elem>, b: &[L::Elem], finish: F);
}

/// In the precision of the numbers.
pub struct Exact;

impl<L: Lane> Precision<L> for Exact {
    #[inline(always)]
    fn multiply<F: Finish<L>>(rows: usize, inner: usize, a: Broadcast<L::Elem>, b: &[L::Elem], finish: F) {
        multiply::<L, F>(rows, inner, a, b, finish);
    }
}

/// What an inner step adds to a sum.
trait Term<L> {
    fn added(sum: L, left: L, right: L) -> L;
}

/// A product of numbers.
struct OneProduct;

impl<L: Lane> Term<L> for OneProduct {
    #[inline(always)]
    fn added(sum: L, left: L, right: L) -> L {
        left.mul_add(right, sum)
    }
}

/// Two products, of pairs in bf16.
struct TwoProducts;

impl<L: Lane32> Term<L> for TwoProducts {
    #[inline(always)]
    fn added(sum: L, left: L, right: L) -> L {
        sum.dot(left, right)
    }
}

/// C[rows][64] = A[rows][inner] B[inner][64], and the sums of B's columns after it if [`Finish::SUMS`].
///
/// # Panics
/// If a matrix is too small.
#[inline(always)]
pub fn multiply<L: Lane, F: Finish<L>>(rows: usize, inner: usize, a: Broadcast<L::Elem>, b: &[L::Elem], finish: F) {
    let all = rows + F::SUMS as usize;
    assert!(rows > 0 && inner > 0 && finish.rows() >= all && b.len() >= inner * HIDDEN);
    assert!(a.data.len() > (rows - 1) * a.row + (inner - 1) * a.column);
    let product = Product::<L, F, OneProduct> { inner, all, a, b: b.as_ptr(), finish, term: PhantomData };
    // A function of its own: the caller would otherwise hold a copy of every tile shape for every product.
    L::vectorize(
        #[inline(always)]
        || L::tiled(product),
    );
}

/// As [`multiply`], of pairs in bf16 ([`Lane32::dot_pairs`]) along the inner dimension.
///
/// # Safety
/// Inside [`Lane32::vectorize_dot`]; the matrices are as large as they say, and [`Finish::SUMS`] is false.
#[inline(always)]
pub unsafe fn multiply_pairs<L: Lane32, F: Finish<L>>(
    rows: usize,
    words: usize,
    a: Broadcast<f32>,
    b: &[f32],
    finish: F,
) {
    L::tiled(Product::<L, F, TwoProducts> { inner: words, all: rows, a, b: b.as_ptr(), finish, term: PhantomData });
}

struct Product<'a, L: Lane, F, T> {
    inner: usize,
    /// Rows of C, that of sums included.
    all: usize,
    a: Broadcast<'a, L::Elem>,
    b: *const L::Elem,
    finish: F,
    term: PhantomData<T>,
}

impl<L: Lane, F: Finish<L>, T: Term<L>> Tiled for Product<'_, L, F, T> {
    /// Covers the rows with tiles of R x C blocks, then with what remains; the row of sums is in the last tile.
    #[inline(always)]
    fn run<const R: usize, const C: usize>(mut self) {
        // SAFETY: the matrices hold `all` rows and `inner` columns, as `multiply` asserted, and tiles end at `all`.
        unsafe {
            let (mut row, all) = (0, self.all);
            while row + R < all || (!F::SUMS && row + R == all) {
                self.tiles::<R, C, false>(row);
                row += R;
            }
            match all - row {
                0 => {}
                1 => self.last::<1, R, C>(row),
                2 => self.last::<2, R, C>(row),
                3 => self.last::<3, R, C>(row),
                4 => self.last::<4, R, C>(row),
                5 => self.last::<5, R, C>(row),
                _ => self.last::<6, R, C>(row),
            }
        }
    }
}

impl<L: Lane, F: Finish<L>, T: Term<L>> Product<'_, L, F, T> {
    /// The last N rows, at most R. Tests of constants: what they exclude is not even compiled.
    #[inline(always)]
    unsafe fn last<const N: usize, const R: usize, const C: usize>(&mut self, row: usize) {
        if const { N <= R } {
            // SAFETY: promised by the caller.
            unsafe { if F::SUMS { self.tiles::<N, C, true>(row) } else { self.tiles::<N, C, false>(row) } }
        }
    }

    #[inline(always)]
    unsafe fn tiles<const R: usize, const C: usize, const SUMS: bool>(&mut self, row: usize) {
        for block in (0..BLOCKS).step_by(C) {
            // SAFETY: promised by the caller.
            unsafe { self.tile::<R, C, SUMS>(row, block) };
        }
    }

    #[inline(always)]
    unsafe fn tile<const R: usize, const C: usize, const SUMS: bool>(&mut self, row: usize, block: usize) {
        // SAFETY: rows row..row + R and blocks block..block + C are inside the matrices; the row of sums is not read
        // from A.
        unsafe {
            let mut tile: [[L; C]; R] = build!(|i| build!(|j| self.finish.start(row + i, block + j)));
            let mut a = self.a.data.as_ptr().wrapping_add(row * self.a.row);
            let mut b = self.b.add(block * LANES);
            for _ in 0..self.inner {
                let right: [L; C] = build!(|j| L::load(b.add(j * LANES)));
                for (i, sums) in tile.iter_mut().enumerate() {
                    if SUMS && i + 1 == R {
                        *sums = build!(|j| sums[j] + right[j]);
                    } else {
                        let left = L::splat(*a.add(i * self.a.row));
                        *sums = build!(|j| T::added(sums[j], left, right[j]));
                    }
                }
                a = a.wrapping_add(self.a.column);
                b = b.wrapping_add(HIDDEN);
            }
            for (i, sums) in tile.iter().enumerate() {
                for j in (0..C).step_by(2) {
                    self.finish.end(row + i, block + j, [sums[j], sums[j + 1]]);
                }
            }
        }
    }
}
