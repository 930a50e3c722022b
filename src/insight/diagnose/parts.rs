//! Work on the samples of a flight, in parts side by side: what a fit waits for is often a single prediction.

use crate::base::lane::fused;
use rayon::prelude::*;

/// Samples of a part; bins and windows, each of which is about several or many samples.
pub const SAMPLES: usize = 4096;
pub const BINS: usize = 1024;
pub const WINDOWS: usize = 64;

/// `one` of each index below `n`, in parts of `part`. The closure has to be inlined, or its body is compiled for the
/// plainest processor.
#[inline(always)]
pub fn each_of<T: Clone + Default + Send>(n: usize, part: usize, one: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut out = vec![T::default(); n];
    out.par_chunks_mut(part).enumerate().for_each(|(p, chunk)| {
        fused(
            #[inline(always)]
            || chunk.iter_mut().enumerate().for_each(|(j, to)| *to = one(p * part + j)),
        );
    });
    out
}
