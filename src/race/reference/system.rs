//! Symmetric linear equations whose unknowns know only their neighbours, but for a few at the end that know all.

use nalgebra::{DMatrix, DVector};

/// Unknowns of a banded part reach so many places back: a node and the two before it, three coordinates each.
const BAND: usize = 8;

/// The lower half of a symmetric matrix: a band, a dense border and the corner that they meet in.
#[derive(Clone, Debug)]
pub struct System {
    band: Vec<[f64; BAND + 1]>,
    /// Row by row, one for each unknown of the band.
    side: Vec<f64>,
    corner: DMatrix<f64>,
}

impl System {
    /// Zeros for so many unknowns in the band and in the border.
    pub fn new(inner: usize, border: usize) -> Self {
        System {
            band: vec![[0.0; BAND + 1]; inner],
            side: vec![0.0; inner * border],
            corner: DMatrix::zeros(border, border),
        }
    }

    pub fn clear(&mut self) {
        self.band.fill([0.0; BAND + 1]);
        self.side.fill(0.0);
        self.corner.fill(0.0);
    }

    /// Adds to the entry of row `i` and column `j` of the lower half; entries with `i < j` are the other half's and are
    /// left out.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let inner = self.band.len();
        if i < j {
        } else if i < inner {
            self.band[i][i - j] += value;
        } else if j < inner {
            self.side[j * self.corner.nrows() + i - inner] += value;
        } else {
            self.corner[(i - inner, j - inner)] += value;
        }
    }

    /// The solution for `right`, after a share `shift` of the diagonal has been added to it; none unless the matrix is
    /// then positive definite.
    pub fn solve(&self, right: &[f64], shift: f64) -> Option<Vec<f64>> {
        let (inner, border) = (self.band.len(), self.corner.nrows());
        let raised = |x: f64| x + shift * x.abs().max(1e-9);
        // Cholesky's decomposition L of the band; `side` and `out` become L^-1 times what they were.
        let mut low = self.band.clone();
        let mut side = self.side.clone();
        let mut out = right.to_vec();
        for i in 0..inner {
            low[i][0] = raised(low[i][0]);
            let first = i.saturating_sub(BAND);
            for j in first..=i {
                let mut x = low[i][i - j];
                for k in first.max(j.saturating_sub(BAND))..j {
                    x -= low[i][i - k] * low[j][j - k];
                }
                if i > j {
                    low[i][i - j] = x / low[j][0];
                } else if x > 0.0 && x.is_finite() {
                    low[i][0] = x.sqrt();
                } else {
                    return None;
                }
            }
            let (before, row) = side.split_at_mut(i * border);
            for k in first..i {
                let factor = low[i][i - k];
                out[i] -= factor * out[k];
                row[..border].iter_mut().zip(&before[k * border..]).for_each(|(a, b)| *a -= factor * b);
            }
            out[i] /= low[i][0];
            row[..border].iter_mut().for_each(|a| *a /= low[i][0]);
        }
        let mut corner = self.corner.clone();
        let mut rest = DVector::from_column_slice(&out[inner..]);
        for i in 0..border {
            corner[(i, i)] = raised(corner[(i, i)]);
        }
        for (row, x) in side.chunks(border).zip(&out) {
            for i in 0..border {
                rest[i] -= row[i] * x;
                for j in 0..=i {
                    corner[(i, j)] -= row[i] * row[j];
                }
            }
        }
        let rest = corner.cholesky()?.solve(&rest);
        for i in (0..inner).rev() {
            let row = &side[i * border..(i + 1) * border];
            let mut x = out[i] - row.iter().zip(&rest).map(|(a, b)| a * b).sum::<f64>();
            for k in i + 1..(i + BAND + 1).min(inner) {
                x -= low[k][k - i] * out[k];
            }
            out[i] = x / low[i][0];
        }
        out[inner..].copy_from_slice(rest.as_slice());
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, Stream};
    use rand::RngExt;
    use rand_distr::StandardNormal;

    #[test]
    fn solves_what_a_dense_solver_solves() {
        let (inner, border) = (30, 5);
        let n = inner + border;
        let mut rng = Philox::new(1).sequence(Stream::Weights, 0, 0);
        let (mut system, mut dense) = (System::new(inner, border), DMatrix::<f64>::zeros(n, n));
        for i in 0..n {
            for j in 0..=i {
                let value = if i == j { 20.0 } else { rng.sample(StandardNormal) };
                if i >= inner || i - j <= BAND {
                    system.add(i, j, value);
                    system.add(j, i, if i == j { 0.0 } else { 99.0 });
                    (dense[(i, j)], dense[(j, i)]) = (value, value);
                }
            }
        }
        let right: Vec<f64> = rng.sample_iter(StandardNormal).take(n).collect();
        let ours = system.solve(&right, 0.5).unwrap();
        for i in 0..n {
            dense[(i, i)] *= 1.5;
        }
        let theirs = dense.clone().cholesky().unwrap().solve(&DVector::from_column_slice(&right));
        assert!(ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() < 1e-12), "{ours:?} {theirs:?}");
        system.add(3, 3, -60.0);
        assert!(system.solve(&right, 0.0).is_none());
    }
}
