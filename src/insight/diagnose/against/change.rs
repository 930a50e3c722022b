//! What two sets of flights of one vehicle say of each other.

use crate::insight::diagnose::judgement::finding::{Status, Value};
use crate::insight::diagnose::selection::accident::LeftOut;
use serde::Serialize;
use std::collections::BTreeMap;

/// The answer to "what changed?".
#[derive(Clone, Debug, Serialize)]
pub struct Changes {
    /// Whether anything is named.
    pub changed: bool,
    /// Names of the earlier logs.
    pub before: Vec<String>,
    /// Names of the later ones.
    pub after: Vec<String>,
    /// What differs, the surest first; what is only suspected comes last.
    pub changes: Vec<Change>,
    /// Effects that both sets show alike: the vehicle's.
    pub both: Vec<Both>,
    /// The smallest differences that these flights would have shown.
    pub would_show: Vec<WouldShow>,
    /// Seconds that were left out because something happened in them.
    pub left_out: Vec<LeftOut>,
}

/// Something that differs.
#[derive(Clone, Debug, Serialize)]
pub struct Change {
    /// Identifier of an effect, or of a number of the compact model.
    pub cause: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// How sure it is.
    pub status: Status,
    /// All that it may be, itself first; only itself where it is named.
    pub members: Vec<&'static str>,
    /// What it means, in a sentence.
    pub sentence: &'static str,
    /// Its size in the earlier flights, by parameter.
    pub before: BTreeMap<String, Value>,
    /// Its size in the later ones.
    pub after: BTreeMap<String, Value>,
    /// Later less earlier.
    pub difference: BTreeMap<String, Value>,
    /// How sure the difference is, in standard deviations of one number.
    pub deviations: f64,
    /// How far apart simulations of the vehicle before and after are after one second of the later flights, m/s; none
    /// where the change is of what the simulator does not have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impact: Option<f64>,
    /// Why it is no more than suspected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// An effect of the vehicle, before and after.
#[derive(Clone, Debug, Serialize)]
pub struct Both {
    /// Identifier.
    pub effect: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// Its size, by parameter.
    pub parameters: BTreeMap<String, Value>,
}

/// The smallest difference that would have been seen.
#[derive(Clone, Debug, Serialize)]
pub struct WouldShow {
    /// Identifier of an effect, or of a number of the compact model.
    pub cause: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// Of its parameter that shows best; a share of the numbers of the compact model.
    pub smallest: f64,
    /// Of the parameter that shows worst, of several axes: the same where it has one.
    pub worst_axis: f64,
    /// A large size of an effect.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub large: Option<f64>,
    /// Of both.
    pub unit: &'static str,
}

impl Changes {
    /// What is named.
    pub fn named(&self) -> impl Iterator<Item = &Change> {
        self.changes.iter().filter(|c| c.status != Status::Suspected)
    }

    /// The answer in a sentence.
    pub fn headline(&self) -> String {
        let names: Vec<&str> = self.named().map(|c| c.name).collect();
        if names.is_empty() { "nothing changed beyond chance".into() } else { format!("changed: {}", names.join(", ")) }
    }
}

impl Change {
    /// What is named may be one of the effects `others` as well, of which it has none yet.
    pub fn or(&mut self, others: Vec<&'static str>) {
        if !others.is_empty() {
            self.members.extend(others);
            self.status = Status::NamedSet;
        }
    }
}

#[cfg(test)]
impl Change {
    /// One that is named alone, of this difference.
    pub fn sample(cause: &'static str, difference: f64, unit: &str) -> Self {
        let size = BTreeMap::from([("size".to_string(), Value::measured(difference, 1e-6, unit))]);
        Change {
            cause,
            name: cause,
            status: Status::Named,
            members: vec![cause],
            sentence: "",
            before: size.clone(),
            after: size.clone(),
            difference: size,
            deviations: 9.0,
            impact: None,
            why: None,
        }
    }
}
