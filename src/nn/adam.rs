//! Adam (Kingma and Ba, 2015), with epsilon outside the root and after the bias correction.

use crate::lane::Real;

/// First and second moments of the gradient.
#[derive(Clone, Debug)]
pub struct Adam<E> {
    pub first: Vec<E>,
    pub second: Vec<E>,
    pub steps: u64,
}

const BETA: [f64; 2] = [0.9, 0.999];

impl<E: Real + Default> Adam<E> {
    pub fn new(parameters: usize) -> Self {
        Adam { first: vec![E::default(); parameters], second: vec![E::default(); parameters], steps: 0 }
    }

    /// One step against `gradient * scale`.
    pub fn step(&mut self, parameters: &mut [E], gradient: &[E], scale: E, learning_rate: f64, epsilon: f64) {
        self.steps += 1;
        let power = self.steps.min(i32::MAX as u64) as i32;
        let [rate, root] = [learning_rate / (1.0 - BETA[0].powi(power)), 1.0 / (1.0 - BETA[1].powi(power)).sqrt()];
        let [rate, root, epsilon, b1, b2, c1, c2] =
            [rate, root, epsilon, BETA[0], BETA[1], 1.0 - BETA[0], 1.0 - BETA[1]].map(E::of);
        let moments = self.first.iter_mut().zip(&mut self.second);
        for ((p, &g), (m, v)) in parameters.iter_mut().zip(gradient).zip(moments) {
            let g = g * scale;
            *m = b1 * *m + c1 * g;
            *v = b2 * *v + c2 * (g * g);
            *p = *p - rate * *m / (v.sqrt() * root + epsilon);
        }
    }
}
