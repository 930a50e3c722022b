//! Adam (Kingma and Ba, 2015), with epsilon outside the root and after the bias correction.

use super::aligned::Aligned;
use crate::base::lane::{LANES, Lane};

/// First and second moments of the gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct Adam<E> {
    pub first: Aligned<E>,
    pub second: Aligned<E>,
    pub steps: u64,
}

/// Numbers that the parameters share in one step.
#[derive(Clone, Copy, Debug)]
pub struct Rates {
    rate: f64,
    root: f64,
    epsilon: f64,
}

const BETA: [f64; 2] = [0.9, 0.999];

impl<E: Copy + Default> Adam<E> {
    pub fn new(parameters: usize) -> Self {
        Adam { first: Aligned::zeros(parameters), second: Aligned::zeros(parameters), steps: 0 }
    }

    /// Counts a step and returns its bias-corrected rates.
    pub fn advance(&mut self, learning_rate: f64, epsilon: f64) -> Rates {
        self.steps += 1;
        let power = self.steps.min(i32::MAX as u64) as i32;
        let rate = learning_rate / (1.0 - BETA[0].powi(power));
        Rates { rate, root: 1.0 / (1.0 - BETA[1].powi(power)).sqrt(), epsilon }
    }
}

impl Rates {
    /// Moves parameters `p` with moments `m` and `v` against the gradient `g * scale`. Lengths are multiples of 16.
    #[inline(always)]
    pub fn step<L: Lane>(
        &self,
        p: &mut [L::Elem],
        m: &mut [L::Elem],
        v: &mut [L::Elem],
        g: &[L::Elem],
        scale: L::Elem,
    ) {
        let [rate, root, epsilon, b1, b2, c1, c2] =
            [self.rate, self.root, self.epsilon, BETA[0], BETA[1], 1.0 - BETA[0], 1.0 - BETA[1]].map(L::of);
        let scale = L::splat(scale);
        let moments = m.chunks_exact_mut(LANES).zip(v.chunks_exact_mut(LANES));
        for ((p, g), (m, v)) in p.chunks_exact_mut(LANES).zip(g.chunks_exact(LANES)).zip(moments) {
            let g = L::from_slice(g) * scale;
            let first = b1.mul_add(L::from_slice(m), c1 * g);
            let second = b2.mul_add(L::from_slice(v), c2 * (g * g));
            first.write(m);
            second.write(v);
            (L::from_slice(p) - rate * first / second.sqrt().mul_add(root, epsilon)).write(p);
        }
    }
}
