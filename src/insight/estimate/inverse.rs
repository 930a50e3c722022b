//! Inverse of normal equations.

use nalgebra::DMatrix;

/// Added to the diagonal of the correlation form: columns that are the same to twelve digits are taken for the same.
const SINGULAR: f64 = 1e-12;

/// The inverse of a symmetric matrix with `ridge` on its diagonal, by way of its correlation form: units differ by
/// orders of magnitude. A number of which nothing is known takes no part: its row is 0. `None` where the rest is not
/// positive.
pub fn inverse(matrix: &DMatrix<f64>, ridge: &[f64]) -> Option<DMatrix<f64>> {
    let n = matrix.nrows();
    let own = |i: usize| matrix[(i, i)] + ridge[i];
    let scale: Vec<f64> = (0..n).map(|i| if own(i) == 0.0 { 0.0 } else { own(i).max(1e-300).sqrt().recip() }).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| match i == j {
        true if scale[i] == 0.0 => 1.0,
        true => own(i) * scale[i] * scale[i] + SINGULAR,
        false => matrix[(i, j)] * scale[i] * scale[j],
    });
    let inner = scaled.cholesky()?.inverse();
    Some(DMatrix::from_fn(n, n, |i, j| inner[(i, j)] * scale[i] * scale[j]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_do_not_matter_and_what_is_not_positive_has_none() {
        let m = DMatrix::from_row_slice(2, 2, &[4e12, 1e-3, 1e-3, 2e-12]);
        let off = &m * inverse(&m, &[0.0; 2]).unwrap() - DMatrix::identity(2, 2);
        // In the units of the matrix: an entry off the diagonal is as large as the ratio of its rows' units.
        assert!(off[(0, 0)].abs() < 1e-9 && off[(1, 1)].abs() < 1e-9, "{off}");
        assert!(inverse(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 1.0]), &[0.0; 2]).is_none());
        let unknown = inverse(&DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 0.0]), &[0.0; 2]).unwrap();
        assert!((unknown[(0, 0)] - 0.25).abs() < 1e-9 && unknown[(1, 1)] == 0.0, "{unknown}");
        let ridged = inverse(&DMatrix::from_element(1, 1, 3.0), &[1.0]).unwrap();
        assert!((ridged[(0, 0)] - 0.25).abs() < 1e-9);
    }
}
