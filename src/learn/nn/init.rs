//! Initial weights.

use crate::base::rng::Sequence;
use nalgebra::DMatrix;
use rand::RngExt;
use rand_distr::StandardNormal;

/// Fills `weights` `[rows][columns]` with a random matrix with orthogonal rows or columns, whichever are fewer, times
/// `gain`.
pub fn orthogonal(weights: &mut [f32], columns: usize, gain: f64, rng: &mut Sequence) {
    let rows = weights.len() / columns;
    let (long, short) = (rows.max(columns), rows.min(columns));
    let random = DMatrix::from_fn(long, short, |_, _| rng.sample::<f64, _>(StandardNormal));
    let qr = random.qr();
    // Signs of R's diagonal make the distribution uniform over orthogonal matrices.
    let signs = qr.r().diagonal().map(|x| x.signum());
    let q = qr.q();
    for (k, weight) in weights.iter_mut().enumerate() {
        let (row, column) = (k / columns, k % columns);
        let (i, j) = if rows >= columns { (row, column) } else { (column, row) };
        *weight = (gain * q[(i, j)] * signs[j]) as f32;
    }
}
