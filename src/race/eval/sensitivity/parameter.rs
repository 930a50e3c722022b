//! The parameters that a vehicle is randomised in, one at a time.

use crate::model::dynamics::Factors;
use crate::model::vehicle::randomize::RandomizeConfig;

/// One randomised factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Of roll, pitch, yaw, thrust.
    TimeConstant(usize),
    /// Of roll, pitch, yaw.
    MaxRate(usize),
    Thrust,
    Drag,
    /// Of the battery at the start; not a factor but a share, 0 empty, 1 full.
    Charge,
}

const AXES: [&str; 4] = ["roll", "pitch", "yaw", "thrust"];

impl Parameter {
    /// Everything that `env.randomize` draws.
    pub fn all() -> Vec<Parameter> {
        let time = (0..4).map(Parameter::TimeConstant);
        let rate = (0..3).map(Parameter::MaxRate);
        time.chain(rate).chain([Parameter::Thrust, Parameter::Drag, Parameter::Charge]).collect()
    }

    pub fn name(self) -> String {
        match self {
            Parameter::TimeConstant(i) => format!("time constant, {}", AXES[i]),
            Parameter::MaxRate(i) => format!("maximum rate, {}", AXES[i]),
            Parameter::Thrust => "thrust".into(),
            Parameter::Drag => "drag".into(),
            Parameter::Charge => "charge".into(),
        }
    }

    /// The values that are tried.
    pub fn values(self) -> Vec<f64> {
        let from = if self == Parameter::Charge { 0 } else { 5 };
        (from..=from + 10).map(|tenths| f64::from(tenths) / 10.0).collect()
    }

    /// From where to where a policy was trained.
    pub fn trained(self, config: &RandomizeConfig) -> [f64; 2] {
        match self {
            Parameter::TimeConstant(_) => config.time_constant,
            Parameter::MaxRate(_) => config.max_rate,
            Parameter::Thrust => config.thrust,
            Parameter::Drag => config.drag,
            Parameter::Charge => config.charge,
        }
    }

    /// The factors and the charge of a vehicle that is nominal but for this value.
    pub fn vehicle(self, value: f64) -> (Factors, f64) {
        let mut factors = Factors::NOMINAL;
        let mut charge = 1.0;
        match self {
            Parameter::TimeConstant(i) => factors.time_constant[i] = value,
            Parameter::MaxRate(i) => factors.max_rate[i] = value,
            Parameter::Thrust => factors.thrust = value,
            Parameter::Drag => factors.drag = value,
            Parameter::Charge => charge = value,
        }
        (factors, charge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_is_tried_once() {
        let names: std::collections::BTreeSet<_> = Parameter::all().into_iter().map(Parameter::name).collect();
        assert_eq!(names.len(), 10);
        assert_eq!(Parameter::Charge.values().first(), Some(&0.0));
        let (factors, charge) = Parameter::MaxRate(1).vehicle(0.7);
        assert_eq!((factors.max_rate, factors.thrust, charge), ([1.0, 0.7, 1.0], 1.0, 1.0));
    }
}
