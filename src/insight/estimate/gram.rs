//! Inner products of columns, by stretch of time: every linear fit, test and interval is small algebra on them.

use nalgebra::DMatrix;
use rayon::prelude::*;

/// A row that belongs to a stretch of time.
pub trait Stretch: Sync {
    /// Number of the stretch.
    fn stretch(&self) -> u32;
}

impl Stretch for u32 {
    fn stretch(&self) -> u32 {
        *self
    }
}

/// Inner products of columns with each other, of each stretch of time.
#[derive(Clone, Debug)]
pub struct Grams {
    pub blocks: Vec<DMatrix<f64>>,
    pub sum: DMatrix<f64>,
}

impl Grams {
    /// Of `columns`, each with values by channel, whitened; a channel that a column does not touch may be empty. `rows`
    /// are those of each channel, `blocks` the number of stretches.
    pub fn new<C: AsRef<[Vec<f64>]> + Sync, R: Stretch>(columns: &[&C], rows: &[Vec<R>], blocks: usize) -> Self {
        let n = columns.len();
        let active = |c: usize| (0..n).filter(|&j| !columns[j].as_ref()[c].is_empty()).collect::<Vec<_>>();
        let one = |c: usize| {
            let columns: Vec<&[f64]> = active(c).iter().map(|&j| &columns[j].as_ref()[c][..]).collect();
            by_stretch(&columns, &rows[c], blocks)
        };
        let by_channel: Vec<_> = (0..rows.len()).into_par_iter().map(one).collect();
        let mut all = vec![DMatrix::zeros(n, n); blocks];
        for (c, grams) in by_channel.into_iter().enumerate() {
            let active = active(c);
            for (whole, gram) in all.iter_mut().zip(grams) {
                for (a, &i) in active.iter().enumerate() {
                    for (b, &j) in active.iter().enumerate().take(a + 1) {
                        whole[(i, j)] += gram[(a, b)];
                        if i != j {
                            whole[(j, i)] += gram[(a, b)];
                        }
                    }
                }
            }
        }
        let sum = all.iter().fold(DMatrix::zeros(n, n), |sum, gram| sum + gram);
        Self { blocks: all, sum }
    }

    /// The part of `m` in these rows and columns.
    pub fn pick(m: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| m[(rows[i], columns[j])])
    }
}

/// Lower triangles of the products of one channel's columns, by stretch.
fn by_stretch<R: Stretch>(columns: &[&[f64]], rows: &[R], blocks: usize) -> Vec<DMatrix<f64>> {
    let mut out = vec![DMatrix::zeros(columns.len(), columns.len()); blocks];
    let mut begin = 0;
    for run in rows.chunk_by(|a, b| a.stretch() == b.stretch()) {
        let gram = &mut out[run[0].stretch() as usize];
        let end = begin + run.len();
        for (a, x) in columns.iter().enumerate() {
            for (b, y) in columns.iter().enumerate().take(a + 1) {
                gram[(a, b)] += dot(&x[begin..end], &y[begin..end]);
            }
        }
        begin = end;
    }
    out
}

/// Eight sums side by side, so that they do not wait for each other.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (xs, ys) = (x.chunks_exact(8), y.chunks_exact(8));
    let rest: f64 = xs.remainder().iter().zip(ys.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in xs.zip(ys) {
        (0..8).for_each(|k| sums[k] += a[k] * b[k]);
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_by_hand() {
        let (a, b) = ([vec![1.0, 2.0, 3.0], vec![5.0]], [vec![1.0, 1.0, 1.0], vec![]]);
        let grams = Grams::new(&[&a, &b], &[vec![0u32, 0, 1], vec![1]], 2);
        assert_eq!(grams.blocks[0], DMatrix::from_row_slice(2, 2, &[5.0, 3.0, 3.0, 2.0]));
        assert_eq!(grams.blocks[1], DMatrix::from_row_slice(2, 2, &[34.0, 3.0, 3.0, 1.0]));
        assert_eq!(grams.sum[(0, 0)], 39.0);
    }
}
