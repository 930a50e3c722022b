//! A configuration in layers: built-in values, then the file's, then the command line's.

use super::later;
use super::{Config, DEFAULT, LIBRARY, Setting};
use crate::base::check::{BadInput, Check, Invalid};
use crate::base::document::{Document, decode, nearest};
use toml::{Table, Value};

/// Keys of which the one set last removes the other.
const EXCLUSIVE: [&str; 2] = ["budget.minutes", "budget.steps"];

pub struct Layers<'a> {
    base: Document,
    file: Document,
    settings: &'a [Setting],
}

impl<'a> Layers<'a> {
    /// The file found as `name`, between the built-in values and `settings`.
    pub fn open(name: &str, settings: &'a [Setting]) -> Result<Self, BadInput> {
        Ok(Self { base: LIBRARY.built_in(DEFAULT)?, file: LIBRARY.open(name)?, settings })
    }

    /// Lays them over each other, decodes and checks.
    pub fn resolve(&self) -> Result<Config, BadInput> {
        let known = self.known_keys();
        let mut table = self.base.table().clone();
        check_keys(self.file.table(), "", &known).map_err(|invalid| self.file.blame(invalid))?;
        forget_exclusive(&mut table, |key| self.file.sets(key));
        lay(&mut table, &self.whole_file());
        for setting in self.settings {
            check_key(&setting.key, &known).map_err(|invalid| BadInput::at(&setting.option, invalid))?;
            forget_exclusive(&mut table, |key| key == setting.key);
            lay(&mut table, &nest(&setting.key, setting.value.clone()));
        }
        let config: Config = decode(table).map_err(|invalid| self.blame(invalid))?;
        config.check().map_err(|invalid| self.blame(invalid))?;
        Ok(config)
    }

    /// The file's table. One that sets every key is that of a run, and keys that came after it have their old meaning;
    /// in any other, what is not set is as built in.
    fn whole_file(&self) -> Table {
        let mut table = self.file.table().clone();
        let mut keys = Vec::new();
        collect_keys(self.base.table(), "", &mut keys);
        let set = |key: &str| later::is_later(key) || EXCLUSIVE.contains(&key) || self.file.sets(key);
        if keys.iter().all(|key| set(key)) {
            later::complete(&mut table, None);
        }
        table
    }

    /// Names the layer that the value came from.
    pub fn blame(&self, invalid: Invalid) -> BadInput {
        let inside = |outer: &str| invalid.key == outer || invalid.key.starts_with(&format!("{outer}."));
        if let Some(setting) = self.settings.iter().rev().find(|setting| inside(&setting.key)) {
            return BadInput::at(&setting.option, invalid);
        }
        // A table's own complaint, such as neither of two keys, belongs to the file even where it lacks the table.
        let built_in = !self.file.sets(&invalid.key) && self.base.sets(&invalid.key);
        let place = if built_in { self.base.place_of(&invalid.key) } else { self.file.place_of(&invalid.key) };
        BadInput::at(place, invalid)
    }

    fn known_keys(&self) -> Vec<String> {
        let mut keys: Vec<_> = EXCLUSIVE.map(String::from).into();
        collect_keys(self.base.table(), "", &mut keys);
        keys.sort_unstable();
        keys.dedup();
        keys
    }
}

fn join(outer: &str, key: &str) -> String {
    if outer.is_empty() { key.into() } else { format!("{outer}.{key}") }
}

/// All keys, of tables and of values.
fn collect_keys(table: &Table, outer: &str, keys: &mut Vec<String>) {
    for (key, value) in table {
        let key = join(outer, key);
        if let Value::Table(inner) = value {
            collect_keys(inner, &key, keys);
        }
        keys.push(key);
    }
}

fn check_keys(table: &Table, outer: &str, known: &[String]) -> Result<(), Invalid> {
    for (key, value) in table {
        let key = join(outer, key);
        check_key(&key, known)?;
        if let Value::Table(inner) = value {
            check_keys(inner, &key, known)?;
        }
    }
    Ok(())
}

fn check_key(key: &str, known: &[String]) -> Result<(), Invalid> {
    if known.iter().any(|known| known == key) {
        return Ok(());
    }
    let advice = match nearest(key, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "remove it; the keys are those of the built-in a2rl.toml, see `racer train --help`".into(),
    };
    Err(Invalid::new(key, "an unknown key", "", &advice))
}

/// Values of `over` replace those of `under`; tables are merged.
fn lay(under: &mut Table, over: &Table) {
    for (key, value) in over {
        match (under.get_mut(key), value) {
            (Some(Value::Table(under)), Value::Table(over)) => lay(under, over),
            _ => drop(under.insert(key.clone(), value.clone())),
        }
    }
}

fn forget_exclusive(table: &mut Table, sets: impl Fn(&str) -> bool) {
    if EXCLUSIVE.iter().any(|key| sets(key)) {
        for key in EXCLUSIVE {
            let (outer, inner) = key.split_once('.').unwrap_or(("", key));
            if let Some(Value::Table(table)) = table.get_mut(outer) {
                table.remove(inner);
            }
        }
    }
}

/// `a.b` = value as nested tables.
fn nest(key: &str, value: Value) -> Table {
    let (outer, value) = match key.split_once('.') {
        Some((outer, rest)) => (outer, Value::Table(nest(rest, value))),
        None => (key, value),
    };
    Table::from_iter([(outer.into(), value)])
}
