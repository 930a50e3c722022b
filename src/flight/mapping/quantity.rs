//! Numbers of a stream out of columns: field, unit, scale, offset.

use super::units::{Duration, Unit};
use crate::base::check::Invalid;
use serde::Deserialize;

/// When the rows of a table were measured.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    pub field: String,
    #[serde(default)]
    pub unit: Duration,
}

/// Several numbers that belong together, each (scale x + offset) in `unit`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, bound = "U: serde::de::DeserializeOwned + Default")]
pub struct Vector<U> {
    /// Column of each component; with a minus before its name, x is the column's negative.
    pub fields: Vec<String>,
    #[serde(default)]
    pub unit: U,
    /// One for each component, or one for all; 1 by default.
    #[serde(default)]
    pub scale: Vec<f64>,
    /// One for each component; none by default.
    #[serde(default)]
    pub offset: Vec<f64>,
    /// A topic or table other than the stream's, interpolated to the stream's times.
    pub source: Option<String>,
}

/// A number, (scale x + offset) in `unit`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, bound = "U: serde::de::DeserializeOwned + Default")]
pub struct Scalar<U> {
    /// Column of x; with a minus before its name, x is its negative.
    pub field: Option<String>,
    /// In place of `field`: several columns, whose mean x is.
    pub mean: Option<Vec<String>>,
    #[serde(default)]
    pub unit: U,
    #[serde(default = "one")]
    pub scale: f64,
    #[serde(default)]
    pub offset: f64,
}

fn one() -> f64 {
    1.0
}

/// A field's column and sign.
pub(super) fn signed(field: &str) -> (f64, &str) {
    field.strip_prefix('-').map_or((1.0, field), |column| (-1.0, column))
}

impl<U: Unit> Vector<U> {
    /// (Source, column) of every field, where the stream reads `source`.
    pub(super) fn columns<'a>(&'a self, source: &'a str) -> Vec<(&'a str, &'a str)> {
        let source = self.source.as_deref().unwrap_or(source);
        self.fields.iter().map(|field| (source, signed(field).1)).collect()
    }

    pub(super) fn check(&self, count: usize) -> Result<(), Invalid> {
        let (fields, offsets) = (self.fields.len(), self.offset.len());
        Invalid::unless(fields == count, "fields", format!("{fields} of them"), &format!("{count} columns"), "")?;
        check_fields("fields", &self.fields)?;
        let scales = self.scale.len();
        let expected = format!("[s] or {count} numbers");
        Invalid::unless(scales <= 1 || scales == count, "scale", format!("{:?}", self.scale), &expected, "")?;
        self.scale.iter().try_for_each(|&scale| check_scale(scale))?;
        let ok = offsets == 0 || offsets == count && self.offset.iter().all(|offset| offset.is_finite());
        Invalid::unless(ok, "offset", format!("{:?}", self.offset), &format!("{count} finite numbers"), "")
    }

    /// Component k in SI where its column holds `x`.
    pub(super) fn value(&self, k: usize, x: f64) -> f64 {
        let sign = signed(&self.fields[k]).0;
        let scale = self.scale.get(k).or(self.scale.first()).unwrap_or(&1.0);
        (sign * scale * x + self.offset.get(k).unwrap_or(&0.0)) * self.unit.factor()
    }
}

impl<U: Unit> Scalar<U> {
    pub(super) fn fields(&self) -> &[String] {
        self.mean.as_deref().unwrap_or(self.field.as_slice())
    }

    pub(super) fn columns<'a>(&'a self, source: &'a str) -> Vec<(&'a str, &'a str)> {
        self.fields().iter().map(|field| (source, signed(field).1)).collect()
    }

    pub(super) fn check(&self, _count: usize) -> Result<(), Invalid> {
        let found = if self.field.is_some() { "both" } else { "neither" };
        Invalid::unless(self.field.is_some() != self.mean.is_some(), "", found, "either `field` or `mean`", "")?;
        Invalid::unless(!self.fields().is_empty(), "mean", "no column", "one column or more", "")?;
        check_fields(if self.mean.is_some() { "mean" } else { "field" }, self.fields())?;
        check_scale(self.scale)?;
        Invalid::unless(self.offset.is_finite(), "offset", self.offset, "a finite number", "")
    }

    /// In SI, where the columns of the fields hold `x`.
    pub(super) fn value(&self, x: impl Iterator<Item = f64>) -> f64 {
        let fields = self.fields();
        let sum: f64 = fields.iter().zip(x).map(|(field, x)| signed(field).0 * x).sum();
        (self.scale * sum / fields.len() as f64 + self.offset) * self.unit.factor()
    }
}

fn check_fields(key: &str, fields: &[String]) -> Result<(), Invalid> {
    let named = fields.iter().all(|field| !signed(field).1.is_empty());
    Invalid::unless(named, key, "a column without a name", "names of columns", "")
}

fn check_scale(scale: f64) -> Result<(), Invalid> {
    Invalid::unless(scale.is_finite() && scale != 0.0, "scale", scale, "a finite number other than 0", "")
}
