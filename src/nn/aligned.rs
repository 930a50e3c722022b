//! Memory on 64-byte borders: a 512-bit load that straddles two cache lines costs twice.

use crate::lane::{LANES, Portable};
use std::ops::{Deref, DerefMut};

/// A vector of numbers whose first one lies on a 64-byte border.
#[derive(Clone, Debug)]
pub struct Aligned<E> {
    blocks: Vec<Portable<E>>,
    len: usize,
}

impl<E: Copy + Default> Aligned<E> {
    /// `len` zeros.
    pub fn zeros(len: usize) -> Self {
        Aligned { blocks: vec![Portable([E::default(); LANES]); len.div_ceil(LANES)], len }
    }
}

impl<E> Deref for Aligned<E> {
    type Target = [E];
    #[inline(always)]
    fn deref(&self) -> &[E] {
        // SAFETY: a block is an array of `LANES` numbers, and `len` of them are there.
        unsafe { std::slice::from_raw_parts(self.blocks.as_ptr().cast(), self.len) }
    }
}

impl<E> DerefMut for Aligned<E> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [E] {
        // SAFETY: as above.
        unsafe { std::slice::from_raw_parts_mut(self.blocks.as_mut_ptr().cast(), self.len) }
    }
}
