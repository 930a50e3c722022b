//! Gusts: coloured random forces, and coloured random motion of the air.

use crate::truth::effects::terms::Terms;
use nalgebra::Vector3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;

/// What blows for one integration step, world.
#[derive(Clone, Copy, Debug)]
pub struct Air {
    /// Force over mass, m/s2.
    pub force: Vector3<f64>,
    /// Velocity of the air, m/s.
    pub velocity: Vector3<f64>,
}

/// Random but steady weather.
#[derive(Debug)]
pub struct Weather {
    gusts: Option<[f64; 2]>,
    turbulence: Option<[f64; 2]>,
    force: Vector3<f64>,
    /// Two lags one after the other: air has no jumps.
    stirred: Vector3<f64>,
    velocity: Vector3<f64>,
    rng: StdRng,
}

impl Weather {
    pub fn new(terms: &Terms, seed: u64) -> Self {
        let zero = Vector3::zeros();
        let rng = StdRng::seed_from_u64(seed ^ 0x3ea7);
        let (gusts, turbulence) = (terms.gusts, terms.turbulence);
        Weather { gusts, turbulence, force: zero, stirred: zero, velocity: zero, rng }
    }

    /// The air of the next `dt` seconds.
    pub fn next(&mut self, dt: f64) -> Air {
        if let Some([sigma, tau]) = self.gusts {
            let keep = (-dt / tau).exp();
            self.force = self.force * keep + self.noise() * (sigma * (1.0 - keep * keep).sqrt());
        }
        if let Some([sigma, tau]) = self.turbulence {
            let keep = (-dt / tau).exp();
            self.stirred = self.stirred * keep + self.noise() * (1.0 - keep * keep).sqrt();
            // The second lag halves the variance.
            self.velocity += (self.stirred * (sigma * 2.0_f64.sqrt()) - self.velocity) * (dt / tau);
        }
        Air { force: self.force, velocity: self.velocity }
    }

    fn noise(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.rng.sample::<f64, _>(StandardNormal))
    }
}
