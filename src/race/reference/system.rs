//! Symmetric linear equations whose unknowns know only those shortly before them, but for a few at the end that know
//! all.

use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// The lower half of a symmetric matrix: rows that begin where their first entry is (an envelope, which Cholesky's
/// decomposition does not leave), a dense border and the corner that they meet in. Time and memory grow with the
/// number of unknowns.
#[derive(Clone, Debug)]
pub struct System {
    /// Place in the matrix of each unknown, as the caller counts them.
    place: Vec<usize>,
    /// Of each row the column of its first entry, and where its entries are.
    first: Vec<usize>,
    rows: Vec<Range<usize>>,
    band: Vec<f64>,
    /// Row by row, one for each unknown of the envelope.
    side: Vec<f64>,
    corner: DMatrix<f64>,
}

impl System {
    /// Zeros. `place` puts each unknown into the matrix, whose row `i` begins at column `first[i]`; the rows beyond
    /// `first` are the border.
    pub fn new(place: Vec<usize>, first: Vec<usize>) -> Self {
        let (inner, border) = (first.len(), place.len() - first.len());
        let mut end = 0;
        let row = |(i, first): (usize, &usize)| {
            let begin = end;
            end += i + 1 - first;
            begin..end
        };
        let rows: Vec<_> = first.iter().enumerate().map(row).collect();
        let band = vec![0.0; rows.last().map_or(0, |row| row.end)];
        System { place, first, rows, band, side: vec![0.0; inner * border], corner: DMatrix::zeros(border, border) }
    }

    /// Numbers that it holds.
    #[cfg(test)]
    pub fn entries(&self) -> usize {
        self.band.len() + self.side.len() + self.corner.len()
    }

    pub fn clear(&mut self) {
        self.band.fill(0.0);
        self.side.fill(0.0);
        self.corner.fill(0.0);
    }

    /// Adds to the entry of the unknowns `i` and `j`, which must be one of the matrix. Of the two orders only that of
    /// the lower half counts; the other is left out.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let (i, j, inner) = (self.place[i], self.place[j], self.first.len());
        if i < j {
        } else if i < inner {
            self.band[self.rows[i].start + j - self.first[i]] += value;
        } else if j < inner {
            self.side[j * self.corner.nrows() + i - inner] += value;
        } else {
            self.corner[(i - inner, j - inner)] += value;
        }
    }

    /// The solution for `right`, after a share `shift` of the diagonal has been added to it; none unless the matrix is
    /// then positive definite.
    pub fn solve(&self, right: &[f64], shift: f64) -> Option<Vec<f64>> {
        let (inner, border) = (self.first.len(), self.corner.nrows());
        let raised = |x: f64| x + shift * x.abs().max(1e-9);
        let mut out = vec![0.0; right.len()];
        self.place.iter().zip(right).for_each(|(&place, x)| out[place] = *x);
        // `side` and `out` become L^-1 times what they were.
        let low = self.decompose(&raised)?;
        let mut side = self.side.clone();
        for i in 0..inner {
            let (before, row) = side.split_at_mut(i * border);
            let (diagonal, entries) = low[self.rows[i].clone()].split_last()?;
            for (factor, k) in entries.iter().zip(self.first[i]..) {
                out[i] -= factor * out[k];
                row[..border].iter_mut().zip(&before[k * border..]).for_each(|(a, b)| *a -= factor * b);
            }
            out[i] /= diagonal;
            row[..border].iter_mut().for_each(|a| *a /= diagonal);
        }
        let rest = self.border(&side, &out, &raised)?;
        out[inner..].copy_from_slice(rest.as_slice());
        for i in (0..inner).rev() {
            let row = &side[i * border..(i + 1) * border];
            let (diagonal, entries) = low[self.rows[i].clone()].split_last()?;
            let x = (out[i] - row.iter().zip(&rest).map(|(a, b)| a * b).sum::<f64>()) / diagonal;
            out[i] = x;
            out[self.first[i]..i].iter_mut().zip(entries).for_each(|(above, factor)| *above -= factor * x);
        }
        Some(self.place.iter().map(|&place| out[place]).collect())
    }

    /// Cholesky's decomposition L of the envelope, in its place.
    fn decompose(&self, raised: &dyn Fn(f64) -> f64) -> Option<Vec<f64>> {
        let mut low = self.band.clone();
        for i in 0..self.first.len() {
            let (before, row) = low.split_at_mut(self.rows[i].start);
            let first = self.first[i];
            for j in first..i {
                let other = &before[self.rows[j].clone()];
                let begin = first.max(self.first[j]);
                let product: f64 =
                    row[begin - first..j - first].iter().zip(&other[begin - self.first[j]..]).map(|(a, b)| a * b).sum();
                row[j - first] = (row[j - first] - product) / other[j - self.first[j]];
            }
            let squares: f64 = row[..i - first].iter().map(|x| x * x).sum();
            let diagonal = raised(row[i - first]) - squares;
            if !(diagonal > 0.0 && diagonal.is_finite()) {
                return None;
            }
            row[i - first] = diagonal.sqrt();
        }
        Some(low)
    }

    /// The border's unknowns.
    fn border(&self, side: &[f64], out: &[f64], raised: &dyn Fn(f64) -> f64) -> Option<DVector<f64>> {
        let border = self.corner.nrows();
        let mut corner = self.corner.clone();
        let mut rest = DVector::from_column_slice(&out[self.first.len()..]);
        for i in 0..border {
            corner[(i, i)] = raised(corner[(i, i)]);
        }
        for (row, x) in side.chunks(border).zip(out) {
            for i in 0..border {
                rest[i] -= row[i] * x;
                for j in 0..=i {
                    corner[(i, j)] -= row[i] * row[j];
                }
            }
        }
        Some(corner.cholesky()?.solve(&rest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};
    use rand::RngExt;
    use rand_distr::StandardNormal;

    #[test]
    fn solves_what_a_dense_solver_solves() {
        let (inner, border) = (30, 5);
        let n = inner + border;
        let mut rng = Philox::new(1).sequence(RngStream::Weights, 0, 0);
        // Rows of other lengths, and unknowns in another order than the matrix's.
        let reach = |i: usize| if i % 7 == 6 { 14 } else { 4 };
        let first: Vec<usize> = (0..inner).map(|i: usize| i.saturating_sub(reach(i))).collect();
        let place: Vec<usize> = (0..n).map(|i| i * 8 % n).collect();
        let unknown = |at: usize| place.iter().position(|&p| p == at).unwrap();
        let (mut system, mut dense) = (System::new(place.clone(), first), DMatrix::<f64>::zeros(n, n));
        for i in 0..n {
            for j in 0..=i {
                let value = if i == j { 20.0 } else { rng.sample(StandardNormal) };
                if i >= inner || i - j <= reach(i) {
                    system.add(unknown(i), unknown(j), value);
                    system.add(unknown(j), unknown(i), if i == j { 0.0 } else { 99.0 });
                    (dense[(i, j)], dense[(j, i)]) = (value, value);
                }
            }
        }
        let right: Vec<f64> = rng.sample_iter(StandardNormal).take(n).collect();
        let asked: Vec<f64> = place.iter().map(|&at| right[at]).collect();
        let found = system.solve(&asked, 0.5).unwrap();
        let ours: Vec<f64> = (0..n).map(|at| found[unknown(at)]).collect();
        for i in 0..n {
            dense[(i, i)] *= 1.5;
        }
        let theirs = dense.clone().cholesky().unwrap().solve(&DVector::from_column_slice(&right));
        assert!(ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() < 1e-12), "{ours:?} {theirs:?}");
        system.add(unknown(3), unknown(3), -60.0);
        assert!(system.solve(&right, 0.0).is_none());
    }
}
