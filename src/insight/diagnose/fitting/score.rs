//! The score test: what columns would add to a fit, before they are fitted.

use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use nalgebra::{DMatrix, DVector};

/// What one group of columns adds to another, judged by the stretches of time that agree.
#[derive(Clone, Debug)]
pub struct ScoreTest {
    /// How much the whitened squares would fall.
    pub gain: f64,
    /// U' (sum U_b U_b')^-1 U: for one parameter the number of stretches that agree.
    pub evidence: f64,
    /// Information about the group that the rest leaves, by parameter, and what it was before.
    pub information: DVector<f64>,
    pub raw: DVector<f64>,
    /// Information and score of each stretch of time.
    pub blocks: Vec<(DMatrix<f64>, DMatrix<f64>)>,
}

/// The score test of columns `group` beside columns `rest` for column `residual`. `prior` is that of all columns.
pub fn score(grams: &Grams, rest: &[usize], group: &[usize], residual: usize, prior: &[f64]) -> Option<ScoreTest> {
    let g = &grams.sum;
    let rest_prior: Vec<f64> = rest.iter().map(|&i| prior[i]).collect();
    let inner = inverse(&Grams::pick(g, rest, rest), &rest_prior)?;
    // What the rest would have to become to take the group's place: (J'J)^-1 J'S.
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
        evidence,
        information: information.diagonal(),
        raw: Grams::pick(g, group, group).diagonal(),
        blocks,
    })
}
