//! Thrust over the inputs and the voltage, in the better of two forms; and as the curve of a vehicle.

use super::force::Force;
use super::force_terms::{ForceTerms, POWER, THRUST, VALUES};
use super::nearest::{FlownRange, nearest};
use super::solve::Solution;
use crate::insight::prepare::data::DataPart;
use crate::model::thrust::specific_thrust;
use nalgebra::DMatrix;

/// Thrust over inputs and voltage as it was fitted: Eq. 7, or a curve at full pack times a power of the voltage. In Eq.
/// 7 the slope with the voltage is a line over the throttle; a flight that is mostly near hover draws the line there,
/// though thrust needs the slope near full throttle.
pub struct Law {
    pub fitted: Solution,
    pub terms: ForceTerms,
}

impl Law {
    /// Of what is over `motors` and a voltage the better of both, else Eq. 7.
    pub fn fit(force: Force, part: DataPart, motors: bool) -> Option<Self> {
        let terms = force.terms().clone();
        let fitted = force.fit(part)?;
        let by_power =
            ForceTerms { curves: ForceTerms::curve(false), power_at_v: Some(terms.volts[1]), ..terms.clone() };
        if motors
            && terms.by_voltage()
            && let Some(other) = force.with(by_power.clone()).fit(part)
            && other.noise.last() < fitted.noise.last()
        {
            return Some(Self { fitted: other, terms: by_power });
        }
        Some(Self { fitted, terms })
    }

    /// Thrust over mass, m/s2, and its derivative by each of the fitted numbers.
    fn at(&self, u: f64, v: f64) -> (f64, Vec<f64>) {
        let values = &self.fitted.values;
        let c: [f64; 6] = std::array::from_fn(|k| values[THRUST + k]);
        let mut by: Vec<f64> = self.terms.curves.iter().map(|c| specific_thrust(c, u, v)).collect();
        let Some(full_v) = self.terms.power_at_v else { return (specific_thrust(&c, u, v), by) };
        let factor = (v / full_v).powf(values[POWER]);
        let thrust = factor * specific_thrust(&c, u, v);
        by.iter_mut().for_each(|by| *by *= factor);
        by.push(thrust * (v / full_v).ln());
        (thrust, by)
    }

    /// The solution with the curve of a vehicle that is nearest to this law of `input`, which is one of the command and
    /// the voltage.
    pub fn over(&self, input: &dyn Fn(f64, f64) -> f64, terms: &ForceTerms, flown: FlownRange) -> Option<Solution> {
        let (curve, by_law) = nearest(terms, flown, &|u, v| self.at(input(u, v), v))?;
        let power = self.terms.power_at_v.map(|_| POWER);
        let numbers: Vec<usize> = (0..self.terms.curves.len()).map(|k| THRUST + k).chain(power).collect();
        let mut out = self.fitted.clone();
        let mut map = DMatrix::identity(VALUES, VALUES);
        for &k in &numbers {
            (map[(k, k)], out.values[k]) = (0.0, 0.0);
        }
        for (i, value) in curve.iter().enumerate() {
            out.values[THRUST + i] = *value;
            numbers.iter().enumerate().for_each(|(j, &k)| map[(THRUST + i, k)] = by_law[(i, j)]);
        }
        out.covariance = &map * &out.covariance * map.transpose();
        Some(out)
    }
}
