//! Every threshold that decides something about a log, an identification or a diagnosis, by the question that it answers, each with
//! where it comes from. Tolerances of an algorithm and sizes of a filter stand beside the algorithm.
//!
//! `cargo bench --bench hidden_effects -- --criteria` scales each by half and by two and says what changes.

pub mod believed;
pub mod chance;
pub mod complete;
pub mod consistent;
pub mod drifted;
pub mod evident;
pub mod flown;
pub mod material;
pub mod replicated;
pub mod rival;
pub mod shown;
pub mod usable;

use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Where a threshold comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A derivation or a reference.
    Theory(&'static str),
    /// Set by what came out, with the command or the data.
    Calibrated(&'static str),
    /// A choice that nothing but plausibility supports, and why.
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
        believed::ALL,
        evident::ALL,
        replicated::ALL,
        material::ALL,
        rival::ALL,
        complete::ALL,
        chance::ALL,
        drifted::ALL,
        shown::ALL,
    ];
    questions.into_iter().flatten().copied()
}

/// Scales criteria, each given as `NAME=FACTOR`, for the rest of this process. Only before any was read, and once.
///
/// # Errors
///
/// Where a criterion does not exist, a factor is no positive number, or they were scaled before.
pub fn scale(changes: &[String]) -> Result<(), String> {
    if changes.is_empty() {
        return Ok(());
    }
    let mut factors = BTreeMap::new();
    for change in changes {
        let (name, factor) = change.split_once('=').ok_or(format!("expected NAME=FACTOR, found {change}"))?;
        let known = all().find(|criterion| criterion.name == name);
        let criterion = known.ok_or(format!("no criterion is called {name}; src/insight/criteria lists them"))?;
        let factor: f64 = factor.parse().map_err(|_| format!("{name}: expected a number, found {factor}"))?;
        if !(factor.is_finite() && factor > 0.0) {
            return Err(format!("{name}: expected a factor above 0, found {factor}"));
        }
        factors.insert(criterion.name, factor);
    }
    FACTORS.set(factors).map_err(|_| "criteria are scaled once, when the program starts".into())
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
            let (Source::Theory(why) | Source::Calibrated(why) | Source::Assumed(why)) = criterion.source;
            assert!(why.len() > 10 && criterion.value > 0.0 && criterion.what.ends_with('.'), "{criterion:?}");
        }
    }

    #[test]
    fn what_cannot_be_scaled_says_so() {
        assert!(scale(&["NOTHING=2".into()]).unwrap_err().contains("NOTHING"));
        assert!(scale(&["LEAST_GAIN=0".into()]).unwrap_err().contains("above 0"));
        assert!(scale(&["LEAST_GAIN".into()]).unwrap_err().contains("NAME=FACTOR"));
    }
}
