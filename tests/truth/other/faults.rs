//! What is hidden in a flight, by name, as numbers that the equations ask for.

use crate::truth::effects::Hidden;
use nalgebra::Vector3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use std::collections::BTreeMap;

/// See the module. What is not hidden has size 0.
#[derive(Clone, Debug)]
pub struct Faults {
    sizes: BTreeMap<String, f64>,
    /// Length of the flight, s.
    pub seconds: f64,
    /// A direction, for what has one; of the ground, for wind.
    pub along: Vector3<f64>,
    /// Which motor, or axis.
    pub which: usize,
    /// How strong the moving air is, at each tenth of a second, in three directions.
    pub stirred: Vec<Vector3<f64>>,
}

impl Faults {
    pub fn new(hidden: &[Hidden], seed: u64, seconds: f64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed ^ 0xfa17);
        let mut normal = || Vector3::from_fn(|_, _| rng.sample::<f64, _>(StandardNormal));
        let along = normal().normalize();
        let mut now = Vector3::zeros();
        let mut stirred = Vec::new();
        // Forgets in 0.8 s, variance 1.
        let keep = (-0.1_f64 / 0.8).exp();
        for _ in 0..(seconds * 10.0) as usize + 20 {
            now = now * keep + normal() * (1.0 - keep * keep).sqrt();
            stirred.push(now);
        }
        let sizes = hidden.iter().map(|h| (h.id.clone(), h.size)).collect();
        Faults { sizes, seconds, along, which: (seed % 4) as usize, stirred }
    }

    /// The size of the cause of this name; 0 where it is not hidden.
    pub fn of(&self, id: &str) -> f64 {
        self.sizes.get(id).copied().unwrap_or(0.0)
    }

    pub fn has(&self, id: &str) -> bool {
        self.sizes.contains_key(id)
    }

    /// The stirred air at a moment: a straight line between tenths of a second.
    pub fn air(&self, time: f64) -> Vector3<f64> {
        let at = (time * 10.0).max(0.0);
        let (i, share) = ((at as usize).min(self.stirred.len() - 2), at.fract());
        self.stirred[i] * (1.0 - share) + self.stirred[i + 1] * share
    }
}
