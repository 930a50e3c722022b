//! What becomes of a matrix product while it is still in registers.

use super::HIDDEN;
use super::gemm::Finish;
use crate::base::lane::{LANES, Lane};

#[inline(always)]
fn at(row: usize, block: usize) -> usize {
    row * HIDDEN + block * LANES
}

/// C = tanh(bias + A B): a hidden layer. `bias` `[64]`, `out` `[rows][64]`.
pub struct Activate<'a, E> {
    bias: &'a [E],
    out: &'a mut [E],
}

impl<'a, E> Activate<'a, E> {
    #[inline(always)]
    pub fn new(bias: &'a [E], out: &'a mut [E]) -> Self {
        assert!(bias.len() >= HIDDEN);
        Activate { bias, out }
    }
}

impl<L: Lane> Finish<L> for Activate<'_, L::Elem> {
    #[inline(always)]
    fn rows(&self) -> usize {
        self.out.len() / HIDDEN
    }
    #[inline(always)]
    unsafe fn start(&self, _row: usize, block: usize) -> L {
        // SAFETY: the length was checked when this was made.
        unsafe { L::load(self.bias.as_ptr().add(block * LANES)) }
    }
    #[inline(always)]
    unsafe fn end(&mut self, row: usize, block: usize, pair: [L; 2]) {
        let [x, y] = L::tanh_pair(pair);
        // SAFETY: promised by the caller.
        unsafe {
            let out = self.out.as_mut_ptr().add(at(row, block));
            x.store(out);
            y.store(out.add(LANES));
        }
    }
}

/// H = (A B) (1 - H^2): from the derivative by a hidden layer to that by its tanh's argument. H is `[rows][64]`.
pub struct Descend<'a, E>(pub &'a mut [E]);

impl<L: Lane> Finish<L> for Descend<'_, L::Elem> {
    #[inline(always)]
    fn rows(&self) -> usize {
        self.0.len() / HIDDEN
    }
    #[inline(always)]
    unsafe fn start(&self, _row: usize, _block: usize) -> L {
        L::zero()
    }
    #[inline(always)]
    unsafe fn end(&mut self, row: usize, block: usize, pair: [L; 2]) {
        for (j, d) in pair.into_iter().enumerate() {
            // SAFETY: promised by the caller.
            unsafe {
                let p = self.0.as_mut_ptr().add(at(row, block + j));
                let h = L::load(p);
                (d * (-h).mul_add(h, L::one())).store(p);
            }
        }
    }
}

/// C += A B: the gradient by weights, with that by the biases as last row if `BIAS`. C is `[rows][64]`.
pub struct Accumulate<'a, E, const BIAS: bool>(pub &'a mut [E]);

impl<L: Lane, const BIAS: bool> Finish<L> for Accumulate<'_, L::Elem, BIAS> {
    const SUMS: bool = BIAS;

    #[inline(always)]
    fn rows(&self) -> usize {
        self.0.len() / HIDDEN
    }
    #[inline(always)]
    unsafe fn start(&self, row: usize, block: usize) -> L {
        // SAFETY: promised by the caller.
        unsafe { L::load(self.0.as_ptr().add(at(row, block))) }
    }
    #[inline(always)]
    unsafe fn end(&mut self, row: usize, block: usize, pair: [L; 2]) {
        // SAFETY: promised by the caller.
        unsafe {
            let p = self.0.as_mut_ptr().add(at(row, block));
            pair[0].store(p);
            pair[1].store(p.add(LANES));
        }
    }
}
