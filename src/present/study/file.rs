//! A study's file: which settings, which seeds, which budget.

use crate::base::check::{BadInput, Check, Invalid};
use crate::base::document::{Document, Library, decode};
use crate::race::config::DEFAULT;
use serde::Deserialize;
use std::path::Path;
use toml::{Table, Value};

const LIBRARY: Library = Library {
    kind: "study",
    folder: "configs/studies",
    builtin: &[
        ("paper_configurations", include_str!("../../../configs/studies/paper_configurations.toml")),
        ("cpu_configurations", include_str!("../../../configs/studies/cpu_configurations.toml")),
        ("seeds_paper", include_str!("../../../configs/studies/seeds_paper.toml")),
        ("seeds", include_str!("../../../configs/studies/seeds.toml")),
        ("regularisation", include_str!("../../../configs/studies/regularisation.toml")),
        ("regularisation_factorial", include_str!("../../../configs/studies/regularisation_factorial.toml")),
        ("entropy", include_str!("../../../configs/studies/entropy.toml")),
    ],
};
/// Most seeds of a study; beyond that somebody has mistaken the key for the seed itself.
const SEEDS: i64 = 10_000;

/// The file's content.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Configuration that all settings start from: name or file.
    #[serde(default = "default_config")]
    pub config: String,
    /// How many (1 to that many), or a list; the configuration's own where there is none.
    seeds: Option<Value>,
    /// Budget of each run, wall-clock minutes; the configuration's own where there is neither this nor `steps`.
    pub minutes: Option<f64>,
    /// Budget of each run, environment steps: repeats bit for bit on any machine of the same vector width.
    pub steps: Option<u64>,
    /// Vehicles that each snapshot is flown with, the first nominal; the configuration's `eval.agents` where there is
    /// none.
    pub agents: Option<u64>,
    /// A section counts as learnt from the first snapshot on with which this share of the random-start agents pass it.
    #[serde(default = "tenth")]
    pub section_share: f64,
    /// Runs at a time, each with its share of the processors. More finish a study sooner, one uses a wall-clock budget
    /// best.
    #[serde(default = "one")]
    pub jobs: usize,
    /// Keys that are the same in all settings.
    #[serde(default)]
    pub set: Table,
    /// Keys with a list of values each; all combinations are settings.
    #[serde(default)]
    pub grid: Table,
    /// Named values for several keys together, in named groups; combined with each other and with the grid.
    #[serde(default)]
    pub cases: Table,
}

fn default_config() -> String {
    DEFAULT.into()
}

fn tenth() -> f64 {
    0.1
}

fn one() -> usize {
    1
}

impl Study {
    /// Finds `name` in the working directory, in `configs/studies/` or among the built-in ones.
    pub fn open(name: &str) -> Result<(Document, Self), BadInput> {
        let document = LIBRARY.open(name)?;
        let study = Self::of(&document)?;
        Ok((document, study))
    }

    /// What `document` says, checked as far as it can be alone.
    pub fn of(document: &Document) -> Result<Self, BadInput> {
        let study: Self = decode(document.table().clone()).map_err(|invalid| document.blame(invalid))?;
        study.check().map_err(|invalid| document.blame(invalid))?;
        Ok(study)
    }

    /// The seeds in order, or none where the configuration's own is to be used.
    pub fn seeds(&self) -> Result<Option<Vec<u64>>, Invalid> {
        const EXPECTED: &str = "how many, or a list of different whole numbers, zero or more";
        let whole = |value: &Value| value.as_integer().and_then(|seed| u64::try_from(seed).ok());
        let list: Option<Vec<u64>> = match &self.seeds {
            None => return Ok(None),
            Some(Value::Integer(count @ 1..=SEEDS)) => Some((1..=*count as u64).collect()),
            Some(Value::Array(list)) if !list.is_empty() => list.iter().map(whole).collect(),
            Some(_) => None,
        };
        let found = || Invalid::new("seeds", shown(self.seeds.as_ref()), EXPECTED, "write seeds = 8 or seeds = [1, 2]");
        let list = list.ok_or_else(found)?;
        let twice = list.iter().enumerate().any(|(i, seed)| list[..i].contains(seed));
        if twice { Err(found()) } else { Ok(Some(list)) }
    }
}

fn shown(value: Option<&Value>) -> String {
    value.map_or(String::new(), Value::to_string)
}

/// What a study is called: its file's name.
pub fn name_of(argument: &str) -> String {
    Path::new(argument).file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

impl Check for Study {
    fn check(&self) -> Result<(), Invalid> {
        self.seeds()?;
        if self.minutes.is_some() && self.steps.is_some() {
            return Err(Invalid::new("steps", "both", "either minutes or steps", "remove one"));
        }
        let share = self.section_share;
        Invalid::unless(
            share > 0.0 && share <= 1.0,
            "section_share",
            share,
            "above 0, at most 1",
            "the paper has 0.1",
        )?;
        Invalid::unless((1..=1024).contains(&self.jobs), "jobs", self.jobs, "1 to 1024", "1 runs one after the other")
    }
}
