//! Numbers of a stream out of columns: field, unit, scale, offset.

use super::units::{Duration, Unit};
use crate::base::check::Invalid;
use serde::Deserialize;
use std::ops::RangeInclusive;

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
    /// Column of each component; with a minus before its name, x is the column's negative; with a question mark behind
    /// it a file may lack the column.
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
    /// Column of x; with a minus before its name, x is its negative; with a question mark behind it a file may lack it.
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

/// A condition, by the number in a column.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flag {
    pub field: String,
    /// It holds where the column has one of these numbers; any but 0 by default.
    pub equals: Option<Vec<f64>>,
    /// Numbers that say nothing.
    #[serde(default)]
    pub unknown: Vec<f64>,
    /// A topic or table other than the stream's.
    pub source: Option<String>,
}

/// A field's column.
pub(super) fn column(field: &str) -> &str {
    let field = field.strip_prefix('-').unwrap_or(field);
    field.strip_suffix('?').unwrap_or(field)
}

/// The sign before a field.
fn sign(field: &str) -> f64 {
    if field.starts_with('-') { -1.0 } else { 1.0 }
}

/// Whether a file may lack a field.
pub(super) fn optional(field: &str) -> bool {
    field.ends_with('?')
}

impl<U: Unit> Vector<U> {
    /// (Source, field) of every field, where the stream reads `source`.
    pub(super) fn columns<'a>(&'a self, source: &'a str) -> Vec<(&'a str, &'a str)> {
        let source = self.source.as_deref().unwrap_or(source);
        self.fields.iter().map(|field| (source, &**field)).collect()
    }

    pub(super) fn check(&self, counts: RangeInclusive<usize>) -> Result<(), Invalid> {
        let (count, offsets) = (self.fields.len(), self.offset.len());
        let (least, most) = (counts.start(), counts.end());
        let expected = if least == most { format!("{most} columns") } else { format!("{least} to {most} columns") };
        Invalid::unless(counts.contains(&count), "fields", format!("{count} of them"), &expected, "")?;
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
        let sign = sign(&self.fields[k]);
        let scale = self.scale.get(k).or(self.scale.first()).unwrap_or(&1.0);
        (sign * scale * x + self.offset.get(k).unwrap_or(&0.0)) * self.unit.factor()
    }
}

impl<U: Unit> Scalar<U> {
    pub(super) fn fields(&self) -> &[String] {
        self.mean.as_deref().unwrap_or(self.field.as_slice())
    }

    pub(super) fn columns<'a>(&'a self, source: &'a str) -> Vec<(&'a str, &'a str)> {
        self.fields().iter().map(|field| (source, &**field)).collect()
    }

    pub(super) fn check(&self, _counts: RangeInclusive<usize>) -> Result<(), Invalid> {
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
        let sum: f64 = fields.iter().zip(x).map(|(field, x)| sign(field) * x).sum();
        (self.scale * sum / fields.len() as f64 + self.offset) * self.unit.factor()
    }
}

impl Flag {
    pub(super) fn columns<'a>(&'a self, source: &'a str) -> Vec<(&'a str, &'a str)> {
        vec![(self.source.as_deref().unwrap_or(source), &self.field)]
    }

    pub(super) fn check(&self, _counts: RangeInclusive<usize>) -> Result<(), Invalid> {
        check_fields("field", std::slice::from_ref(&self.field))?;
        let some = self.equals.as_ref().is_none_or(|equals| !equals.is_empty());
        Invalid::unless(some, "equals", "no number", "one number or more", "leave it out for any but 0")
    }

    /// 1 where the condition holds for `x`, 0 where it does not, NaN where that is not known.
    pub(super) fn value(&self, x: f64) -> f64 {
        let holds = self.equals.as_ref().map_or(x != 0.0, |equals| equals.contains(&x));
        if x.is_nan() || self.unknown.contains(&x) { f64::NAN } else { holds.into() }
    }
}

fn check_fields(key: &str, fields: &[String]) -> Result<(), Invalid> {
    let named = fields.iter().all(|field| !column(field).is_empty());
    Invalid::unless(named, key, "a column without a name", "names of columns", "")
}

fn check_scale(scale: f64) -> Result<(), Invalid> {
    Invalid::unless(scale.is_finite() && scale != 0.0, "scale", scale, "a finite number other than 0", "")
}
