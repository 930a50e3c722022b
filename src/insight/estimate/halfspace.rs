//! Least squares under linear inequalities: what physics says of numbers, whatever the data say.

use super::inverse::inverse;
use nalgebra::{DMatrix, DVector};

/// Numbers `x` with `row . x >= least`.
#[derive(Clone, Debug, PartialEq)]
pub struct Halfspace {
    pub row: Vec<f64>,
    pub least: f64,
}

impl Halfspace {
    /// Number `i` of `n` is at least `least`, with `sign` 1; at most `-least`, with `sign` -1.
    pub fn bound(i: usize, n: usize, sign: f64, least: f64) -> Self {
        let mut row = vec![0.0; n];
        row[i] = sign;
        Self { row, least }
    }

    /// `row . x - least`: negative outside.
    pub fn room(&self, x: &[f64]) -> f64 {
        self.row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>() - self.least
    }
}

/// Beyond this a number lies outside of a half-space, in standard deviations of its row.
const OUTSIDE: f64 = 1e-9;

/// The `d` that minimises `d' matrix d / 2 - downhill' d`, with `ridge` on the diagonal, in all half-spaces. `None`
/// where the matrix is not positive, or no `d` lies in all of them.
///
/// By way of the dual problem, whose multipliers only have to be positive (Lawson and Hanson, "Solving Least Squares
/// Problems", SIAM 1995, chapter 23).
pub fn minimum(matrix: &DMatrix<f64>, ridge: &[f64], downhill: &[f64], within: &[Halfspace]) -> Option<Vec<f64>> {
    let n = matrix.nrows();
    let inverse = inverse(matrix, ridge)?;
    let free = &inverse * DVector::from_column_slice(downhill);
    // Rows in units of their own standard deviations; a row of zeros says nothing.
    let mut rows: Vec<(DVector<f64>, DVector<f64>, f64)> = Vec::new();
    for Halfspace { row, least } in within {
        let row = DVector::from_column_slice(row);
        let moved = &inverse * &row;
        let sd = row.dot(&moved).max(0.0).sqrt();
        if sd > 0.0 {
            rows.push((row / sd, moved / sd, least / sd));
        }
    }
    let outside = |d: &DVector<f64>, i: usize| rows[i].2 - rows[i].0.dot(d);
    let solve = |active: &[usize]| {
        let k = active.len();
        let products =
            DMatrix::from_fn(k, k, |a, b| rows[active[a]].0.dot(&rows[active[b]].1) + if a == b { 1e-12 } else { 0.0 });
        let wanted = DVector::from_fn(k, |a, _| outside(&free, active[a]));
        Some(products.cholesky()?.solve(&wanted))
    };
    let at = |active: &[usize], push: &[f64]| {
        active.iter().zip(push).fold(free.clone(), |d, (&i, push)| d + &rows[i].1 * *push)
    };
    let (mut active, mut push): (Vec<usize>, Vec<f64>) = Default::default();
    for _ in 0..10 * (n + rows.len() + 1) {
        let d = at(&active, &push);
        let worst = (0..rows.len()).filter(|i| !active.contains(i)).map(|i| (outside(&d, i), i));
        match worst.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((most, i)) if most > OUTSIDE => active.push(i),
            _ => return Some(d.iter().copied().collect()),
        }
        push.push(0.0);
        loop {
            let next = solve(&active)?;
            if next.iter().all(|p| *p > 0.0) {
                push = next.iter().copied().collect();
                break;
            }
            // As far as the first that would pull, which leaves.
            let share = |(p, next): (&f64, &f64)| if *next <= 0.0 { p / (p - next) } else { 1.0 };
            let part = push.iter().zip(next.iter()).map(share).fold(1.0, f64::min);
            push.iter_mut().zip(next.iter()).for_each(|(p, next)| *p += part * (next - *p));
            let kept: Vec<usize> = (0..active.len()).filter(|&a| push[a] > 1e-14).collect();
            if kept.len() == active.len() || kept.is_empty() {
                return None;
            }
            active = kept.iter().map(|&a| active[a]).collect();
            push = kept.iter().map(|&a| push[a]).collect();
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};
    use rand::RngExt;

    /// (x - 3)^2 + (y - 3)^2 with x + y at most 4, and x at least 2.5 besides.
    #[test]
    fn by_hand() {
        let matrix = DMatrix::identity(2, 2) * 2.0;
        let most = Halfspace { row: vec![-1.0, -1.0], least: -4.0 };
        let near = |found: Vec<f64>, wanted: [f64; 2]| {
            assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?}");
        };
        near(minimum(&matrix, &[0.0; 2], &[6.0, 6.0], &[]).unwrap(), [3.0, 3.0]);
        near(minimum(&matrix, &[0.0; 2], &[6.0, 6.0], std::slice::from_ref(&most)).unwrap(), [2.0, 2.0]);
        let least = Halfspace::bound(0, 2, 1.0, 2.5);
        near(minimum(&matrix, &[0.0; 2], &[6.0, 6.0], &[most, least]).unwrap(), [2.5, 1.5]);
    }

    /// Random problems: what is found lies inside, and no feasible point beside it is lower.
    #[test]
    fn nothing_inside_is_lower() {
        let mut rng = Philox::new(5).sequence(RngStream::Noise, 0, 0);
        let mut draw = |n: usize| (0..n).map(|_| rng.random_range(-1.0..1.0)).collect::<Vec<f64>>();
        for _ in 0..300 {
            let n = 4;
            let half = DMatrix::from_vec(n, n, draw(n * n));
            let matrix = &half * half.transpose() + DMatrix::identity(n, n) * 0.1;
            let downhill = draw(n);
            // All hold at zero, so that there is a solution.
            let within: Vec<Halfspace> =
                (0..12).map(|_| Halfspace { row: draw(n), least: -0.2 * draw(1)[0].abs() }).collect();
            let found = minimum(&matrix, &vec![0.0; n], &downhill, &within).unwrap();
            assert!(within.iter().all(|h| h.room(&found) > -1e-6), "{found:?}");
            let cost = |x: &[f64]| {
                let x = DVector::from_column_slice(x);
                0.5 * x.dot(&(&matrix * &x)) - x.dot(&DVector::from_column_slice(&downhill))
            };
            for _ in 0..200 {
                let by = draw(n);
                let beside: Vec<f64> = found.iter().zip(&by).map(|(x, by)| x + 0.05 * by).collect();
                let inside = within.iter().all(|h| h.room(&beside) >= 0.0);
                assert!(!inside || cost(&beside) > cost(&found) - 1e-7);
            }
        }
    }
}
