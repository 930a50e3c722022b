//! Covariance for residuals that are neither white nor equally informative: what leaving out stretches of time does to
//! the values.

use super::gram::Grams;
use super::inverse::inverse;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Variance of a number that changes nothing, in whatever units.
const UNKNOWN: f64 = 1e18;

/// Covariance of the numbers whose columns are `own`, from the products with the column `residual`,
/// by leaving out `size` stretches of time after the other (the cluster jackknife, CR3): without a
/// group, the values would move by `(H - H_g)^-1 U_g`, with H the normal equations and U the
/// gradient. Unlike the sum of U U' alone it stays honest where few groups, such as the few yaw
/// steps of a flight, hold most of what is known. With the number of groups that held anything.
/// `None` where all together do not tell the numbers. Cameron and Miller, "A Practitioner's Guide
/// to Cluster-Robust Inference", J. Hum. Resour. 50, 2015.
pub fn jackknife(
    grams: &Grams,
    own: &[usize],
    residual: usize,
    ridge: &[f64],
    size: usize,
) -> Option<(DMatrix<f64>, usize)> {
    let n = own.len();
    let whole = Grams::pick(&grams.sum, own, own);
    let everything = inverse(&whole, ridge)?;
    let all = [own, &[residual]].concat();
    let known = |i: usize| whole[(i, i)] + ridge[i] > 0.0;
    let moved = |group: &[DMatrix<f64>]| {
        let start = DMatrix::zeros(n + 1, n + 1);
        let out = group.iter().fold(start, |sum, gram| sum + Grams::pick(gram, &all, &all));
        if out[(n, n)] <= 0.0 {
            return None;
        }
        let rest = &whole - out.view((0, 0), (n, n));
        // A group without which nothing can be told counts as it is.
        let told = (0..n).all(|i| rest[(i, i)] + ridge[i] > 0.0 || !known(i));
        let inner = inverse(&rest, ridge).filter(|_| told);
        Some(inner.as_ref().unwrap_or(&everything) * out.view((0, n), (n, 1)).column(0))
    };
    let moves: Vec<DVector<f64>> = grams.blocks.par_chunks(size).filter_map(moved).collect();
    let unknown = DMatrix::from_fn(n, n, |i, j| if i == j && !known(i) { UNKNOWN } else { 0.0 });
    let spread = moves.iter().fold(unknown, |sum, moved| sum + moved * moved.transpose());
    Some((spread, moves.len()))
}
