//! The one matrix product behind every layer: C = start + A B with B and C in 16-lane blocks and A read by broadcast.
//!
//! A tile of C stays in registers over the whole of the inner dimension: 24 accumulators for 4 loads and 6 broadcasts an
//! inner step on AVX-512, so the two multiply-add ports never wait for memory.

use crate::lane::{LANES, Lane, Tile};

/// What a product is added to.
#[derive(Clone, Copy)]
pub enum Start<'a, E> {
    /// Nothing.
    Zero,
    /// Row `r` of C starts as `bias[r]`.
    Bias(&'a [E]),
    /// The product is added to C.
    Add,
}

/// A matrix read element by element at any stride.
#[derive(Clone, Copy)]
pub struct Broadcast<'a, E> {
    pub data: &'a [E],
    /// Distance of rows and of columns (the inner dimension).
    pub row: usize,
    pub column: usize,
}

/// C[rows][columns] = start + A[rows][inner] B[inner][columns]. B and C are contiguous in rows of `columns`, a multiple of 16.
///
/// # Panics
/// If a slice is too short.
#[inline]
pub fn multiply<L: Lane>(
    rows: usize,
    inner: usize,
    columns: usize,
    a: Broadcast<L::Elem>,
    b: &[L::Elem],
    c: &mut [L::Elem],
    start: Start<L::Elem>,
) {
    assert!(rows > 0 && inner > 0 && columns % LANES == 0);
    assert!(a.data.len() > (rows - 1) * a.row + (inner - 1) * a.column);
    assert!(b.len() >= inner * columns && c.len() >= rows * columns);
    assert!(!matches!(start, Start::Bias(bias) if bias.len() < rows));
    L::vectorize(
        #[inline(always)]
        || {
            // SAFETY: every index below is within the lengths asserted above.
            unsafe {
                match L::TILE {
                    Tile::Rows6Blocks4 => panels::<L, 6, 4>(rows, inner, columns, a, b, c, start),
                    Tile::Rows6Blocks1 => panels::<L, 6, 1>(rows, inner, columns, a, b, c, start),
                    Tile::Rows2Blocks1 => panels::<L, 2, 1>(rows, inner, columns, a, b, c, start),
                }
            }
        },
    );
}

/// Covers C with tiles of R x C blocks, then with what remains.
#[inline(always)]
unsafe fn panels<L: Lane, const R: usize, const C: usize>(
    rows: usize,
    inner: usize,
    columns: usize,
    a: Broadcast<L::Elem>,
    b: &[L::Elem],
    c: &mut [L::Elem],
    start: Start<L::Elem>,
) {
    let panel = Panel { inner, columns, a, b: b.as_ptr(), start };
    let mut r = 0;
    // SAFETY: `r + R <= rows`, and what `multiply` asserted.
    unsafe {
        while r + R <= rows {
            panel.row_of_tiles::<L, R, C>(r, c.as_mut_ptr());
            r += R;
        }
        match rows - r {
            0 => {}
            1 => panel.row_of_tiles::<L, 1, C>(r, c.as_mut_ptr()),
            2 => panel.row_of_tiles::<L, 2, C>(r, c.as_mut_ptr()),
            3 => panel.row_of_tiles::<L, 3, C>(r, c.as_mut_ptr()),
            4 => panel.row_of_tiles::<L, 4, C>(r, c.as_mut_ptr()),
            _ => panel.row_of_tiles::<L, 5, C>(r, c.as_mut_ptr()),
        }
    }
}

struct Panel<'a, E> {
    inner: usize,
    columns: usize,
    a: Broadcast<'a, E>,
    b: *const E,
    start: Start<'a, E>,
}

impl<E: Copy> Panel<'_, E> {
    #[inline(always)]
    unsafe fn row_of_tiles<L: Lane<Elem = E>, const R: usize, const C: usize>(&self, r: usize, c: *mut E) {
        let blocks = self.columns / LANES;
        let mut block = 0;
        // SAFETY: `block + C <= blocks`.
        unsafe {
            while block + C <= blocks {
                self.tile::<L, R, C>(r, block, c);
                block += C;
            }
            while block < blocks {
                self.tile::<L, R, 1>(r, block, c);
                block += 1;
            }
        }
    }

    #[inline(always)]
    unsafe fn tile<L: Lane<Elem = E>, const R: usize, const C: usize>(&self, r: usize, block: usize, c: *mut E) {
        // SAFETY: rows r..r + R and blocks block..block + C are inside the matrices, as `multiply` asserted.
        unsafe {
            let c = c.add(r * self.columns + block * LANES);
            let at = |i: usize, j: usize| i * self.columns + j * LANES;
            let mut sum: [[L; C]; R] = match self.start {
                Start::Zero => [[L::zero(); C]; R],
                Start::Bias(bias) => std::array::from_fn(|i| [L::splat(*bias.get_unchecked(r + i)); C]),
                Start::Add => std::array::from_fn(|i| std::array::from_fn(|j| L::load(c.add(at(i, j))))),
            };
            let mut a = self.a.data.as_ptr().add(r * self.a.row);
            let mut b = self.b.add(block * LANES);
            for _ in 0..self.inner {
                let right: [L; C] = std::array::from_fn(|j| L::load(b.add(j * LANES)));
                for (i, row) in sum.iter_mut().enumerate() {
                    let left = L::splat(*a.add(i * self.a.row));
                    for (sum, &right) in row.iter_mut().zip(&right) {
                        *sum = left.mul_add(right, *sum);
                    }
                }
                a = a.wrapping_add(self.a.column);
                b = b.wrapping_add(self.columns);
            }
            for (i, row) in sum.iter().enumerate() {
                for (j, &sum) in row.iter().enumerate() {
                    sum.store(c.add(at(i, j)));
                }
            }
        }
    }
}

/// Writes the transpose of `from[rows][64]` to `to[64][rows]`; `rows` is a multiple of 16.
#[inline]
pub fn transpose<L: Lane>(rows: usize, columns: usize, from: &[L::Elem], to: &mut [L::Elem]) {
    assert!(rows % LANES == 0 && columns % LANES == 0 && from.len() >= rows * columns && to.len() >= rows * columns);
    L::vectorize(
        #[inline(always)]
        || {
            for r in (0..rows).step_by(LANES) {
                for c in (0..columns).step_by(LANES) {
                    let mut block: [L; LANES] = std::array::from_fn(|i| L::from_slice(&from[(r + i) * columns + c..]));
                    L::transpose(&mut block);
                    for (j, lane) in block.into_iter().enumerate() {
                        lane.write(&mut to[(c + j) * rows + r..]);
                    }
                }
            }
        },
    );
}
