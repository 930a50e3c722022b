//! What a study comes to: every run with its whole configuration, resolved and checked before the first begins.

use super::axes::{self, StudyCell};
use super::file::{Study, name_of};
use crate::base::check::{BadInput, Check, Invalid};
use crate::base::document::Document;
use crate::race::config::{Setting, Setup};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Everything about a study that its tables need: `plan.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyPlan {
    pub study: String,
    /// Budget of each run; one of the two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub minutes: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    pub section_share: f64,
    /// Sections of the tracks, in the order of flight.
    pub sections: Vec<String>,
    /// Names of the axes.
    pub axes: Vec<String>,
    pub settings: Vec<PlannedSetting>,
    /// In the order in which they are made: all settings with the first seed, then with the next.
    pub runs: Vec<PlannedRun>,
    /// Whether all runs are paid alike, so that their returns can be compared.
    pub same_reward: bool,
}

/// One setting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedSetting {
    pub name: String,
    /// Its value on each axis.
    pub levels: Vec<String>,
    /// What it sets, by key.
    pub keys: Map<String, Value>,
}

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedRun {
    pub name: String,
    /// Place in the list of settings.
    pub setting: usize,
    pub seed: u64,
}

/// A study ready to begin.
pub struct Planned {
    pub plan: StudyPlan,
    /// Base configuration: name or file.
    pub config: String,
    /// What `racer train` sets for each run, and what that resolves to.
    pub runs: Vec<(Vec<Setting>, Setup)>,
}

/// Budget on the command line, which counts before the file's.
#[derive(Clone, Copy, Debug, Default)]
pub struct StudyBudget {
    pub minutes: Option<f64>,
    pub steps: Option<u64>,
}

impl StudyPlan {
    /// Budget of each run, in words.
    pub fn budget(&self) -> String {
        match (self.minutes, self.steps.unwrap_or_default()) {
            (Some(minutes), _) => format!("{minutes} minutes"),
            (None, steps) if steps < 100_000 => format!("{steps} steps"),
            (None, steps) => format!("{:.1} million steps", steps as f64 / 1e6),
        }
    }
}

/// Spans the grid, resolves and checks every run of `study`, which `document` holds. `argument` names the study.
pub fn plan(argument: &str, document: &Document, study: &Study, budget: StudyBudget) -> Result<Planned, BadInput> {
    let blame = |invalid: Invalid| document.blame(invalid);
    let axes = axes::axes(study).map_err(blame)?;
    let cells = axes::cells(study, &axes).map_err(blame)?;
    let seeds = study.seeds().map_err(blame)?;
    let seeds: Vec<Option<u64>> = seeds.map_or(vec![None], |seeds| seeds.into_iter().map(Some).collect());
    let (mut planned, mut runs) = (Vec::new(), Vec::new());
    for seed in seeds {
        for (setting, cell) in cells.iter().enumerate() {
            let settings = settings(document, study, cell, seed, budget);
            // Which of the runs it is, the complaint itself cannot know.
            let named = |bad: BadInput| BadInput { place: format!("setting {}, {}", cell.name, bad.place), ..bad };
            let setup = Setup::load(&study.config, &settings).map_err(named)?;
            let seed = setup.config.seed;
            planned.push(PlannedRun { name: format!("{},seed={seed}", cell.name), setting, seed });
            runs.push((settings, setup));
        }
    }
    let setups: Vec<&Setup> = runs.iter().map(|(_, setup)| setup).collect();
    let first = setups[0];
    let mut sections: Vec<String> = Vec::new();
    for section in setups.iter().flat_map(|setup| &setup.track.sections) {
        if !sections.contains(&section.name) {
            sections.push(section.name.clone());
        }
    }
    let plan = StudyPlan {
        study: name_of(argument),
        minutes: first.config.budget.minutes,
        steps: first.config.budget.steps,
        section_share: study.section_share,
        sections,
        axes: axes.into_iter().map(|axis| axis.name).collect(),
        settings: cells.into_iter().map(described).collect(),
        runs: planned,
        same_reward: setups
            .iter()
            .all(|setup| setup.config.env.reward == first.config.env.reward && setup.track == first.track),
    };
    Ok(Planned { plan, config: study.config.clone(), runs })
}

/// What a run sets, in the order in which it counts.
fn settings(
    document: &Document,
    study: &Study,
    cell: &StudyCell,
    seed: Option<u64>,
    budget: StudyBudget,
) -> Vec<Setting> {
    let own =
        |key: &str, to: &str, value: toml::Value| Setting { key: to.into(), value, option: document.place_of(key) };
    let mut all: Vec<Setting> = Vec::new();
    all.extend(study.agents.map(|agents| own("agents", "eval.agents", (agents as i64).into())));
    for (key, value) in &cell.settings {
        all.push(Setting { key: key.clone(), value: value.clone(), option: place(document, study, key) });
    }
    all.extend(seed.map(|seed| own("seeds", "seed", (seed as i64).into())));
    match budget {
        StudyBudget { minutes: None, steps: None } => {
            all.extend(study.minutes.map(|minutes| own("minutes", "budget.minutes", minutes.into())));
            all.extend(study.steps.map(|steps| own("steps", "budget.steps", (steps as i64).into())));
        }
        StudyBudget { minutes, steps } => {
            all.extend(minutes.map(|minutes| Setting::of("--minutes", "budget.minutes", minutes)));
            all.extend(steps.map(|steps| Setting::of("--steps", "budget.steps", steps as i64)));
        }
    }
    all
}

/// Where the file sets a key of the configuration; keys in quotes are found only as far as their table.
fn place(document: &Document, study: &Study, key: &str) -> String {
    let cases = study.cases.iter().filter_map(|(group, cases)| Some((group, cases.as_table()?)));
    let cases = cases.flat_map(|(group, cases)| cases.keys().map(move |case| format!("cases.{group}.{case}")));
    let tables = ["set", "grid"].map(String::from).into_iter().chain(cases);
    let mut places = tables.map(|table| format!("{table}.{key}"));
    places.find(|place| document.sets(place)).map_or(document.label.clone(), |found| document.place_of(&found))
}

fn described(cell: StudyCell) -> PlannedSetting {
    let json = |value: toml::Value| serde_json::to_value(value).unwrap_or_default();
    let keys = cell.settings.into_iter().map(|(key, value)| (key, json(value))).collect();
    PlannedSetting { name: cell.name, levels: cell.levels, keys }
}

impl Check for StudyPlan {
    fn check(&self) -> Result<(), Invalid> {
        let known = self.runs.iter().all(|run| run.setting < self.settings.len());
        Invalid::unless(known, "runs", "a setting that is not there", "places in the list of settings", "")?;
        let whole = self.settings.iter().all(|setting| setting.levels.len() == self.axes.len());
        Invalid::unless(whole, "settings", "another number of levels", "one for each axis", "")
    }
}
