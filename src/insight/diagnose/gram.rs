//! Inner products of whitened columns, by stretch of time: every linear fit, test and interval is small algebra on them.

use super::predict::CHANNELS;
use super::problem::{ChannelValues, ResidualRow};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Inner products of columns with each other, of each stretch of time.
#[derive(Clone, Debug)]
pub struct Grams {
    pub blocks: Vec<DMatrix<f64>>,
    pub sum: DMatrix<f64>,
}

impl Grams {
    /// Of `columns`, whitened.
    pub fn new(columns: &[&ChannelValues], rows: &[Vec<ResidualRow>; CHANNELS], blocks: usize) -> Self {
        let n = columns.len();
        let by_channel: Vec<Vec<DMatrix<f64>>> = (0..CHANNELS)
            .into_par_iter()
            .map(|c| {
                let active: Vec<usize> = (0..n).filter(|&j| !columns[j][c].is_empty()).collect();
                let mut out = vec![DMatrix::zeros(active.len(), active.len()); blocks];
                let mut begin = 0;
                while begin < rows[c].len() {
                    let block = rows[c][begin].block;
                    let end = (begin..rows[c].len()).find(|&i| rows[c][i].block != block).unwrap_or(rows[c].len());
                    let gram = &mut out[block as usize];
                    for (a, &i) in active.iter().enumerate() {
                        for (b, &j) in active.iter().enumerate().take(a + 1) {
                            let (x, y) = (&columns[i][c][begin..end], &columns[j][c][begin..end]);
                            gram[(a, b)] += dot(x, y);
                        }
                    }
                    begin = end;
                }
                out
            })
            .collect();
        let mut all = vec![DMatrix::zeros(n, n); blocks];
        for (c, grams) in by_channel.into_iter().enumerate() {
            let active: Vec<usize> = (0..n).filter(|&j| !columns[j][c].is_empty()).collect();
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

    pub fn pick(m: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| m[(rows[i], columns[j])])
    }
}

/// Four sums side by side, so that they do not wait for each other.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (xs, ys) = (x.chunks_exact(8), y.chunks_exact(8));
    let rest: f64 = xs.remainder().iter().zip(ys.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in xs.zip(ys) {
        (0..8).for_each(|k| sums[k] += a[k] * b[k]);
    }
    sums.iter().sum::<f64>() + rest
}

/// The inverse of a symmetric matrix with `prior` on its diagonal, scaled first: units differ by orders of magnitude.
pub fn inverse(m: &DMatrix<f64>, prior: &[f64]) -> Option<DMatrix<f64>> {
    let n = m.nrows();
    let scale: Vec<f64> = (0..n).map(|i| (m[(i, i)] + prior[i]).max(1e-300).sqrt().recip()).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        (m[(i, j)] + if i == j { prior[i] } else { 0.0 }) * scale[i] * scale[j] + if i == j { 1e-12 } else { 0.0 }
    });
    let inner = scaled.cholesky()?.inverse();
    Some(DMatrix::from_fn(n, n, |i, j| inner[(i, j)] * scale[i] * scale[j]))
}

/// What one group of columns adds to another, judged by the stretches of time that agree.
#[derive(Clone, Debug)]
pub struct ScoreTest {
    /// Expected change of the group's parameters.
    pub change: DVector<f64>,
    /// How much the whitened squares would fall.
    pub gain: f64,
    /// U' (sum U_b U_b')^-1 U: for one parameter the number of stretches that agree.
    pub evidence: f64,
    /// Information about the group that the rest leaves, by parameter, and what it was before.
    pub information: DVector<f64>,
    pub raw: DVector<f64>,
    /// What the rest would have to become to take the group's place: (J'J)^-1 J'S.
    pub absorbed: DMatrix<f64>,
    /// Information and score of each stretch of time.
    pub blocks: Vec<(DMatrix<f64>, DMatrix<f64>)>,
}

/// The score test of columns `group` beside columns `rest` for column `residual`. `prior` is that of all columns.
pub fn score(grams: &Grams, rest: &[usize], group: &[usize], residual: usize, prior: &[f64]) -> Option<ScoreTest> {
    let g = &grams.sum;
    let rest_prior: Vec<f64> = rest.iter().map(|&i| prior[i]).collect();
    let inner = inverse(&Grams::pick(g, rest, rest), &rest_prior)?;
    let absorbed = &inner * Grams::pick(g, rest, group);
    let beta = &inner * Grams::pick(g, rest, &[residual]);
    let own = |m: &DMatrix<f64>| {
        // S~' S~ and S~' r~ of one stretch, or of all.
        let cross = Grams::pick(m, rest, group);
        let square = Grams::pick(m, rest, rest);
        let right = Grams::pick(m, group, &[residual])
            - absorbed.transpose() * Grams::pick(m, rest, &[residual])
            - cross.transpose() * &beta
            + absorbed.transpose() * &square * &beta;
        let left = Grams::pick(m, group, group) - absorbed.transpose() * &cross - cross.transpose() * &absorbed
            + absorbed.transpose() * &square * &absorbed;
        (left, right)
    };
    let (information, u) = own(g);
    let change = inverse(&information, &vec![1e-300; group.len()])? * &u;
    let mut spread = DMatrix::zeros(group.len(), group.len());
    let blocks: Vec<_> = grams.blocks.iter().map(own).collect();
    for (_, ub) in &blocks {
        spread += ub * ub.transpose();
    }
    let robust = inverse(&spread, &vec![1e-300; group.len()])?;
    let evidence = (u.transpose() * robust * &u)[(0, 0)];
    Some(ScoreTest {
        gain: (u.transpose() * &change)[(0, 0)],
        change: change.column(0).into_owned(),
        evidence,
        information: information.diagonal(),
        raw: Grams::pick(g, group, group).diagonal(),
        absorbed,
        blocks,
    })
}
