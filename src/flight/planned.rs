//! A planned flight of the pilot: which manoeuvres, and how often, as a file of TOML.

use super::pilot::Manoeuvre;
use crate::base::check::{BadInput, Check, Invalid};
use crate::base::document::{Document, nearest};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Manoeuvres to be flown in one flight.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlightPlan {
    /// In order of importance; they are flown by turns.
    pub manoeuvre: Vec<PlannedManoeuvre>,
}

/// A kind of manoeuvre, and how often it is flown.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedManoeuvre {
    /// As [`Manoeuvre::name`] has it.
    pub name: String,
    /// 1 to 100.
    pub count: usize,
}

/// How often a kind is flown at most.
const MOST: usize = 100;
/// Time that a manoeuvre takes at most with its approach, and that take-off and landing take, s.
const EACH_S: f64 = 25.0;
const AROUND_S: f64 = 60.0;

impl FlightPlan {
    /// A plan of these.
    pub fn new(kinds: impl IntoIterator<Item = (Manoeuvre, usize)>) -> Self {
        let one = |(kind, count): (Manoeuvre, usize)| PlannedManoeuvre { name: kind.name().into(), count };
        FlightPlan { manoeuvre: kinds.into_iter().map(one).collect() }
    }

    /// Reads a plan. Fails on unknown keys and names, and where nothing is planned.
    pub fn read(path: &Path) -> Result<Self, BadInput> {
        Document::read(path)?.decode()
    }

    /// The manoeuvres one after the other, each kind spread evenly over the flight, so that it is flown early and late.
    pub fn order(&self) -> Vec<Manoeuvre> {
        let one = |planned: &PlannedManoeuvre| {
            let (kind, count) = (Manoeuvre::named(&planned.name), planned.count);
            (0..count).filter_map(move |i| Some(((i as f64 + 0.5) / count as f64, kind?)))
        };
        let mut all: Vec<(f64, Manoeuvre)> = self.manoeuvre.iter().flat_map(one).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.into_iter().map(|(_, kind)| kind).collect()
    }

    /// Time that is enough for all of it, s; the pilot lands as soon as it is done.
    pub fn enough_s(&self) -> f64 {
        AROUND_S + EACH_S * self.manoeuvre.iter().map(|planned| planned.count as f64).sum::<f64>()
    }
}

impl Check for FlightPlan {
    fn check(&self) -> Result<(), Invalid> {
        let advice = "add a table [[manoeuvre]] with a name and a count";
        Invalid::unless(!self.manoeuvre.is_empty(), "manoeuvre", "none", "at least one manoeuvre", advice)?;
        for (i, planned) in self.manoeuvre.iter().enumerate() {
            planned.check().map_err(|invalid| invalid.within(&format!("manoeuvre[{i}]")))?;
            let twice = self.manoeuvre[..i].iter().any(|before| before.name == planned.name);
            let advice = "give one table with the sum of the counts";
            let key = format!("manoeuvre[{i}].name");
            Invalid::unless(!twice, &key, &planned.name, "each manoeuvre once", advice)?;
        }
        Ok(())
    }
}

impl Check for PlannedManoeuvre {
    fn check(&self) -> Result<(), Invalid> {
        let known = Manoeuvre::named(&self.name).is_some();
        let near = nearest(&self.name, Manoeuvre::ALL.into_iter().map(Manoeuvre::name));
        let advice = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let advice = advice + "`racer fly --help` lists them";
        Invalid::unless(known, "name", &self.name, "a manoeuvre of the pilot", &advice)?;
        Invalid::unless((1..=MOST).contains(&self.count), "count", self.count, &format!("1 to {MOST}"), "")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<FlightPlan, BadInput> {
        Document::parse("plan.toml", text)?.decode()
    }

    #[test]
    fn a_plan_comes_back_as_it_was_written_and_each_kind_is_flown_early_and_late() {
        let plan = FlightPlan::new([(Manoeuvre::Dive, 4), (Manoeuvre::Punch, 2)]);
        assert_eq!(read(&toml::to_string(&plan).unwrap()).unwrap(), plan);
        let [d, p] = [Manoeuvre::Dive, Manoeuvre::Punch];
        assert_eq!(plan.order(), [d, p, d, d, p, d]);
        assert!(plan.enough_s() > 6.0 * 15.0 + 30.0);
    }

    #[test]
    fn what_cannot_be_flown_is_refused_with_what_would_be_right() {
        for (text, parts) in [
            ("", &["manoeuvre", "add the key"][..]),
            ("manoeuvre = []", &["at least one manoeuvre"]),
            ("[[manoeuvre]]\nname = \"dives\"\ncount = 1", &["plan.toml:2", "dives", "did you mean `dive`?"]),
            ("[[manoeuvre]]\nname = \"dive\"\ncount = 0", &["plan.toml:3", "1 to 100"]),
            ("[[manoeuvre]]\nname = \"dive\"\ntimes = 1", &["unknown key", "count"]),
            (
                "[[manoeuvre]]\nname = \"dive\"\ncount = 1\n[[manoeuvre]]\nname = \"dive\"\ncount = 1",
                &["each manoeuvre once"],
            ),
        ] {
            let said = read(text).unwrap_err().to_string();
            for part in parts {
                assert!(said.contains(part), "{text}: `{part}` is not in:\n{said}");
            }
        }
    }
}
