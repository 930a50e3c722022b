//! A value with its interval, or the reason why there is none.

use super::solve::Solution;
use crate::insight::criteria::identified::WIDEST_INTERVAL;
use serde::Serialize;

/// A value and its 95 % confidence interval; where `why` is set, the logs cannot tell it and the numbers are null.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Estimated {
    /// The best value.
    pub value: Option<f64>,
    /// Lower end of the interval.
    pub low: Option<f64>,
    /// Upper end of the interval.
    pub high: Option<f64>,
    /// Why the logs cannot tell it, or what else to know about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl Estimated {
    /// `value` within `half_width` on either side.
    pub fn new(value: f64, half_width: f64) -> Self {
        Self { value: Some(value), low: Some(value - half_width), high: Some(value + half_width), why: None }
    }

    /// Value `i` of a fit. A value at one of its bounds has no interval.
    pub fn of(solution: &Solution, i: usize) -> Self {
        let value = solution.values[i];
        if solution.at_bound[i] {
            return Self { value: Some(value), why: Some("at the bound of the search".into()), ..Self::default() };
        }
        Self::new(value, solution.half_width(i))
    }

    /// The same value, which is not kept: without an interval, and why.
    pub fn left(self, why: &str) -> Self {
        Self { low: None, high: None, why: Some(why.into()), ..self }
    }

    /// None, and why.
    pub fn unknown(why: impl Into<String>) -> Self {
        Self { why: Some(why.into()), ..Self::default() }
    }

    /// The same in another unit.
    pub fn times(&self, factor: f64) -> Self {
        let scaled = |x: Option<f64>| x.map(|x| x * factor);
        Self { value: scaled(self.value), low: scaled(self.low), high: scaled(self.high), why: self.why.clone() }
    }

    /// The same less `by`.
    pub fn less(&self, by: f64) -> Self {
        let [value, low, high] = [self.value, self.low, self.high].map(|x| x.map(|x| x - by));
        Self { value, low, high, why: self.why.clone() }
    }

    /// Its square root.
    pub fn root(&self) -> Self {
        let [value, low, high] = [self.value, self.low, self.high].map(|x| x.map(f64::sqrt));
        Self { value, low, high, why: self.why.clone() }
    }

    /// One over it.
    pub fn inverse(&self) -> Self {
        let [value, low, high] = [self.value, self.high, self.low].map(|x| x.map(|x| 1.0 / x));
        Self { value, low, high, why: self.why.clone() }
    }

    /// Why this number is not told, whatever it predicts.
    pub fn vague(&self) -> Option<String> {
        let value = self.value?;
        match self.interval() {
            None => Some(format!("the fit ended at the bound of the search, {value:.4}")),
            Some([low, high]) if high - low > WIDEST_INTERVAL.get() * value.abs() => {
                Some(format!("its interval, {low:.4} to {high:.4}, is wider than its value"))
            }
            Some(_) => None,
        }
    }

    /// The interval, where there is one.
    pub fn interval(&self) -> Option<[f64; 2]> {
        Some([self.low?, self.high?])
    }
}
