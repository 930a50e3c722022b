//! Numbers that begin on a cache line: a block that straddles two lines costs two loads.

use crate::base::lane::{LANES, Portable};
use std::fmt;
use std::ops::{Deref, DerefMut};

/// A vector of fixed length that begins on a cache line, as do all its multiples of 16 numbers.
#[derive(Clone)]
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
        // SAFETY: blocks are arrays of 16 numbers whose size is a multiple of their alignment, so they lie without
        // gaps; `len` is at most 16 times their number.
        unsafe { std::slice::from_raw_parts(self.blocks.as_ptr().cast(), self.len) }
    }
}

impl<E> DerefMut for Aligned<E> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [E] {
        // SAFETY: as in `deref`.
        unsafe { std::slice::from_raw_parts_mut(self.blocks.as_mut_ptr().cast(), self.len) }
    }
}

impl<E: PartialEq> PartialEq for Aligned<E> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<E: fmt::Debug> fmt::Debug for Aligned<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}
