//! The axes of a study and the settings that they span.

use super::file::Study;
use super::names;
use crate::base::check::Invalid;
use toml::{Table, Value};

/// Keys that the study itself sets in every run, and the key of its file that does.
const RESERVED: [(&str, &str); 3] = [("seed", "seeds"), ("budget.minutes", "minutes"), ("budget.steps", "steps")];
/// Most settings of a study.
const MOST: usize = 100_000;

/// Something that varies: a key of the grid, or a group of cases.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyAxis {
    pub name: String,
    pub levels: Vec<AxisValue>,
}

/// One value of an axis: what it is called, and what it sets.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisValue {
    pub label: String,
    pub settings: Vec<(String, Value)>,
}

/// One setting: a level of each axis.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyCell {
    pub name: String,
    /// Label of its level on each axis.
    pub levels: Vec<String>,
    /// What all its runs set: first what is fixed, then each axis.
    pub settings: Vec<(String, Value)>,
}

/// The axes in the file's order, cases before the grid.
pub fn axes(study: &Study) -> Result<Vec<StudyAxis>, Invalid> {
    let mut axes = Vec::new();
    for (group, cases) in &study.cases {
        axes.push(group_axis(group, cases).map_err(|invalid| invalid.within("cases"))?);
    }
    let grid = flat(&study.grid);
    let keys: Vec<String> = grid.iter().map(|(key, _)| key.clone()).collect();
    for ((key, values), name) in grid.into_iter().zip(names::short(&keys)) {
        let Value::Array(values) = values else {
            return Err(Invalid::new(&key, values, "a list of values", "write it in [set] where it does not vary")
                .within("grid"));
        };
        let level = |value: Value| AxisValue { label: names::value(&value), settings: vec![(key.clone(), value)] };
        axes.push(StudyAxis { name, levels: values.into_iter().map(level).collect() });
    }
    axes.iter().try_for_each(check_levels)?;
    check_keys(study, &axes)?;
    Ok(axes)
}

/// All combinations of levels; the last axis varies fastest. One without axes.
pub fn cells(study: &Study, axes: &[StudyAxis]) -> Result<Vec<StudyCell>, Invalid> {
    let many = axes.iter().try_fold(1usize, |many, axis| many.checked_mul(axis.levels.len()));
    if many.is_none_or(|many| many > MOST) {
        return Err(Invalid::new("grid", "more combinations", &format!("at most {MOST}"), "take values out"));
    }
    let fixed = flat(&study.set);
    let mut cells = vec![(Vec::<String>::new(), Vec::<String>::new(), fixed)];
    for axis in axes {
        let grown = cells.iter().flat_map(|(levels, parts, settings)| {
            axis.levels.iter().map(move |level| {
                // Values are called after their key, cases by their own name.
                let value = level.settings.first().filter(|_| level.settings.len() == 1).map(|(_, value)| value);
                let named = value.is_some_and(|value| names::value(value) == level.label);
                let part = if named { format!("{}={}", axis.name, level.label) } else { level.label.clone() };
                (with(levels, level.label.clone()), with(parts, part), [&settings[..], &level.settings[..]].concat())
            })
        });
        cells = grown.collect();
    }
    let name = |parts: &[String]| if parts.is_empty() { "base".into() } else { names::join(parts) };
    let cells = cells.into_iter().map(|(levels, parts, settings)| StudyCell { name: name(&parts), levels, settings });
    let cells: Vec<StudyCell> = cells.collect();
    let twice = cells.iter().enumerate().find(|(i, cell)| cells[..*i].iter().any(|other| other.name == cell.name));
    match twice {
        Some((_, cell)) => {
            Err(Invalid::new("grid", format!("{} twice", cell.name), "different settings", "take one out"))
        }
        None => Ok(cells),
    }
}

fn with(list: &[String], one: String) -> Vec<String> {
    let mut list = list.to_vec();
    list.push(one);
    list
}

fn group_axis(group: &str, cases: &Value) -> Result<StudyAxis, Invalid> {
    let example = "write [cases.GROUP] with lines such as name = { \"ppo.environments\" = 2048, \"ppo.rollout\" = 64 }";
    let Value::Table(cases) = cases else {
        return Err(Invalid::new(group, cases, "a table of named cases", example));
    };
    let levels = cases.iter().map(|(label, settings)| match settings {
        Value::Table(settings) => Ok(AxisValue { label: label.clone(), settings: flat(settings) }),
        other => Err(Invalid::new(&format!("{group}.{label}"), other, "a table of keys and values", example)),
    });
    Ok(StudyAxis { name: group.into(), levels: levels.collect::<Result<_, _>>()? })
}

fn check_levels(axis: &StudyAxis) -> Result<(), Invalid> {
    let StudyAxis { name, levels } = axis;
    Invalid::unless(!levels.is_empty(), name, "nothing", "at least one value", "add one, or take the key out")?;
    let twice = levels.iter().enumerate().find(|(i, level)| levels[..*i].iter().any(|l| l.label == level.label));
    match twice {
        Some((_, level)) => {
            Err(Invalid::new(name, format!("{} twice", level.label), "different values", "take one out"))
        }
        None => Ok(()),
    }
}

/// No key is set in two places, and none that the study sets itself.
fn check_keys(study: &Study, axes: &[StudyAxis]) -> Result<(), Invalid> {
    let mut seen: Vec<(String, String)> =
        study.agents.iter().map(|_| ("eval.agents".into(), "agents".into())).collect();
    let mut sets = vec![("set".to_string(), flat(&study.set))];
    for axis in axes {
        let mut keys: Vec<(String, Value)> = axis.levels.iter().flat_map(|level| level.settings.clone()).collect();
        keys.sort_by(|a, b| a.0.cmp(&b.0));
        keys.dedup_by(|a, b| a.0 == b.0);
        sets.push((axis.name.clone(), keys));
    }
    for (place, settings) in sets {
        for (key, _) in settings {
            if let Some((_, own)) = RESERVED.iter().find(|(reserved, _)| *reserved == key) {
                return Err(Invalid::new(&key, format!("set by {place}"), "", &format!("use `{own}` of the study")));
            }
            if let Some((_, before)) = seen.iter().find(|(known, _)| *known == key) {
                let found = format!("set by {before} and by {place}");
                return Err(Invalid::new(&key, found, "set in one place", "take one out"));
            }
            seen.push((key, place.clone()));
        }
    }
    Ok(())
}

/// Nested tables as dotted keys.
fn flat(table: &Table) -> Vec<(String, Value)> {
    let mut all = Vec::new();
    for (key, value) in table {
        match value {
            Value::Table(inner) => all.extend(flat(inner).into_iter().map(|(rest, v)| (format!("{key}.{rest}"), v))),
            value => all.push((key.clone(), value.clone())),
        }
    }
    all
}
