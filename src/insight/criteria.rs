//! Every threshold that decides something about a log, an identification or a diagnosis, by the question that it
//! answers, each with where it comes from. Tolerances of an algorithm and sizes of a filter stand beside the algorithm.
//!
//! `cargo bench --bench hidden_effects -- --criteria` scales each by half and by two and says what changes.

pub mod believed;
pub mod chance;
pub mod changed;
pub mod complete;
pub mod consistent;
pub mod drifted;
pub mod evident;
pub mod flown;
pub mod identified;
pub mod material;
pub mod planned;
pub mod replicated;
pub mod rival;
pub mod shown;
pub mod unseen;
pub mod usable;

use crate::base::check::BadInput;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Where a threshold comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A derivation or a reference.
    Theory(&'static str),
    /// A choice, and what speaks for it; nobody has measured it.
    Assumed(&'static str),
}

/// A threshold.
#[derive(Debug)]
pub struct Criterion {
    pub name: &'static str,
    /// What it decides, with its unit.
    pub what: &'static str,
    /// The question that it is a part of.
    pub question: &'static str,
    pub value: f64,
    pub source: Source,
}

/// Why many are what they are.
pub(crate) const UNRECORDED: &str = "set while the hidden-effect benchmark and the measured flights \
    were looked at; what else was tried is not on record";

/// Factors that [`scale`] set.
static FACTORS: OnceLock<BTreeMap<&'static str, f64>> = OnceLock::new();

impl Criterion {
    /// Its value; scaled only where somebody measures what it is worth.
    pub fn get(&self) -> f64 {
        let factor = FACTORS.get().and_then(|factors| factors.get(self.name));
        self.value * factor.unwrap_or(&1.0)
    }

    /// The same as a number of things.
    pub fn count(&self) -> usize {
        self.get().round() as usize
    }
}

/// Every criterion, by question.
pub fn all() -> impl Iterator<Item = &'static Criterion> {
    let questions = [
        usable::ALL,
        consistent::ALL,
        flown::ALL,
        identified::ALL,
        believed::ALL,
        evident::ALL,
        replicated::ALL,
        material::ALL,
        rival::ALL,
        complete::ALL,
        unseen::ALL,
        chance::ALL,
        drifted::ALL,
        changed::ALL,
        planned::ALL,
        shown::ALL,
    ];
    questions.into_iter().flatten().copied()
}

/// Scales criteria, each given as `NAME=FACTOR`, for the rest of this process. Only before any was read, and once.
///
/// # Errors
///
/// Where a criterion does not exist, a factor is no positive number, or they were scaled before.
pub fn scale(changes: &[String]) -> Result<(), BadInput> {
    if changes.is_empty() {
        return Ok(());
    }
    let factors = changes.iter().map(|change| factor(change)).collect::<Result<_, _>>()?;
    let twice =
        |_| BadInput::new("criteria", "scaled before", "criteria that are scaled once", "start another process");
    FACTORS.set(factors).map_err(twice)
}

/// A criterion's name and its factor.
fn factor(change: &str) -> Result<(&'static str, f64), BadInput> {
    let wrong = |expected: &str, advice: &str| BadInput::new("criteria", change, expected, advice);
    let (name, factor) = change.split_once('=').ok_or_else(|| wrong("NAME=FACTOR", "such as LEAST_GAIN=2"))?;
    let known = all().find(|criterion| criterion.name == name);
    let criterion = known.ok_or_else(|| wrong("the name of a criterion", "`racer diagnose --criteria` lists them"))?;
    match factor.parse::<f64>() {
        Ok(factor) if factor.is_finite() && factor > 0.0 => Ok((criterion.name, factor)),
        _ => Err(wrong("a factor above 0", "such as 0.5 or 2")),
    }
}

/// Criteria of one question: what each decides, its value, and its [`Source`].
macro_rules! criteria {
    ($question:literal; $($(#[doc = $what:literal])+ $name:ident = $value:expr, $source:ident($reason:expr);)+) => {
        $($(#[doc = $what])+
        pub static $name: $crate::insight::criteria::Criterion = $crate::insight::criteria::Criterion {
            name: stringify!($name),
            what: concat!($($what),+),
            question: $question,
            value: $value,
            source: $crate::insight::criteria::Source::$source($reason),
        };)+

        /// All of this question.
        pub static ALL: &[&$crate::insight::criteria::Criterion] = &[$(&$name),+];
    };
}
pub(crate) use criteria;

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn each_criterion_has_a_name_and_a_reason_of_its_own() {
        let names: BTreeSet<&str> = all().map(|criterion| criterion.name).collect();
        assert_eq!(names.len(), all().count());
        for criterion in all() {
            let (Source::Theory(why) | Source::Assumed(why)) = criterion.source;
            assert!(why.len() > 10 && criterion.value > 0.0 && criterion.what.ends_with('.'), "{criterion:?}");
        }
    }

    #[test]
    fn what_cannot_be_scaled_says_so() {
        for (change, expected) in
            [("NOTHING=2", "name of a criterion"), ("LEAST_GAIN=0", "above 0"), ("LEAST_GAIN", "NAME=FACTOR")]
        {
            assert!(scale(&[change.into()]).unwrap_err().to_string().contains(expected), "{change}");
        }
    }
}
