//! What stands beside the weights: what whoever flies the policy has to know, and apart from it what it was trained on.
//!
//! Version 1, up to racer at commit 73e7003, had both in one table, with the training as `about`. Version 2 had them
//! apart and said of flying only the rate, the observation's layout and the actions' names. Version 3 says all that
//! flying takes ([`super::describe`]), and no longer how long the training took, so that a training repeats bit for
//! bit: an older racer would refuse both, hence a version. In every version a key that is missing because it came
//! later has its old meaning ([`later`]).

use super::About;
use super::describe::{ACTION_NAMES, control_rate_hz};
use crate::base::check::{Check, Invalid};
use crate::model::vehicle::Vehicle;
use crate::race::config::later;
use crate::race::env::observe::layout;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// A format is this and a version. The version changes where an older racer would misread or refuse the file.
const FORMAT: &str = "racer-policy-";
const VERSION: u32 = 3;
/// This program.
const RACER: &str = env!("CARGO_PKG_VERSION");

#[derive(Serialize)]
struct Metadata<'a> {
    format: String,
    /// Version of the program that wrote it.
    racer: &'a str,
    flying: Value,
    training: &'a About,
}

/// What every version says of asking the policy: the part that this racer must agree with.
#[derive(Debug, PartialEq)]
struct Meaning {
    control_rate_hz: Value,
    /// Name, entries, unit, frame, offset and scale of each group.
    observation: Value,
    /// Names.
    action: Value,
}

impl Meaning {
    /// This version's, for `vehicle`, whose battery scales the voltage.
    fn of(vehicle: &Vehicle) -> Self {
        let observation = serde_json::to_value(layout(&vehicle.battery)).unwrap_or_default();
        Self::told(&json!({
            "control_rate_hz": control_rate_hz(), "observation": observation, "action": ACTION_NAMES,
        }))
    }

    /// As a file of any version tells it.
    fn told(flying: &Value) -> Self {
        let list = |key: &str| flying[key].as_array().cloned().unwrap_or_default();
        let group =
            |group: Value| ["name", "entries", "unit", "frame", "offset", "scale"].map(|key| group[key].clone());
        let name = |action: Value| if action.is_object() { action["name"].clone() } else { action };
        Self {
            control_rate_hz: json!(flying["control_rate_hz"].as_f64()),
            observation: list("observation").into_iter().map(|one| json!(group(one))).collect(),
            action: list("action").into_iter().map(name).collect(),
        }
    }

    /// Whether this version flies policies of `vehicle` in the same way.
    fn check(&self, vehicle: &Vehicle) -> Result<(), Invalid> {
        let ours = Self::of(vehicle);
        let refuse = |ok: bool, key: &str, what: &str| {
            let found = format!("another {what} than this version's");
            Invalid::unless(ok, key, found, "", "fly it with the racer that trained it")
        };
        refuse(self.control_rate_hz == ours.control_rate_hz, "control_rate_hz", "control rate")?;
        refuse(self.observation == ours.observation, "observation", "observation layout")?;
        refuse(self.action == ours.action, "action", "meaning of the actions")
    }
}

/// The metadata of a policy, as JSON, with what [`super::describe`] says of flying it.
pub fn write(about: &About, flying: Value) -> serde_json::Result<String> {
    serde_json::to_string(&Metadata { format: format!("{FORMAT}{VERSION}"), racer: RACER, flying, training: about })
}

/// Reads the metadata of this version or an older one: the version, and what the policy was trained on.
pub fn read(text: &str) -> Result<(u32, About), Invalid> {
    let other = |found: String| Invalid::new("", found, "", "name a policy that `racer train` wrote");
    let mut metadata: Value = serde_json::from_str(text).map_err(|error| other(error.to_string()))?;
    let format = metadata["format"].as_str().unwrap_or_default();
    let version = format.strip_prefix(FORMAT).and_then(|version| version.parse().ok());
    let writer = metadata["racer"].as_str().unwrap_or("an older version").to_string();
    let (version, flying, training) = match version {
        Some(1) => (1, metadata.clone(), metadata["about"].take()),
        Some(version @ 2..=VERSION) => (version, metadata["flying"].take(), metadata["training"].take()),
        Some(version) if version > VERSION => return Err(newer(version, &writer)),
        _ => return Err(other(format!("format {:?}", metadata["format"]))),
    };
    let about: About = decode(completed(training), &writer).map_err(|invalid| invalid.within("training"))?;
    about.check().map_err(|invalid| invalid.within("training"))?;
    Meaning::told(&flying).check(&about.vehicle).map_err(|invalid| invalid.within("flying"))?;
    Ok((version, about))
}

fn newer(version: u32, writer: &str) -> Invalid {
    let found = format!("a policy of format {FORMAT}{version}, written by racer {writer}; this is racer {RACER}");
    let advice = format!("use a racer as new as {writer}; this one reads the formats up to {FORMAT}{VERSION}");
    Invalid::new("format", found, "", &advice)
}

/// `training` with the keys that came after it was written.
fn completed(mut training: Value) -> Value {
    for part in ["env", "eval"] {
        let Ok(mut table) = toml::Table::deserialize(&training[part]) else { continue };
        later::complete(&mut table, Some(part));
        training[part] = serde_json::to_value(table).unwrap_or_default();
    }
    training
}

fn decode<T: DeserializeOwned>(value: Value, writer: &str) -> Result<T, Invalid> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let key = error.path().to_string();
        let advice = format!("it was written by racer {writer}, this is racer {RACER}: use a newer one");
        Invalid::new(&key, error.into_inner(), "", &advice)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::race::config::Setup;
    use serde_json::json;

    fn about() -> About {
        let Setup { config, track, vehicle } = Setup::load("a2rl", &[]).unwrap();
        About { track, vehicle, env: config.env, eval: config.eval, seed: 3, steps: 7, seconds: 0.0 }
    }

    /// Without what only others read.
    fn flying() -> Value {
        let observation = layout(&about().vehicle.battery);
        json!({ "control_rate_hz": control_rate_hz(), "observation": observation, "action": ACTION_NAMES })
    }

    /// The complaint about the metadata after `change`.
    fn refused(change: impl FnOnce(&mut Value)) -> String {
        let mut metadata: Value = serde_json::from_str(&write(&about(), flying()).unwrap()).unwrap();
        change(&mut metadata);
        let Invalid { key, found, advice, .. } = read(&metadata.to_string()).unwrap_err();
        format!("{key}: {found}; {advice}")
    }

    #[test]
    fn version_1_had_it_all_in_one_table_and_version_2_the_time_of_the_training() {
        let mut metadata: Value = serde_json::from_str(&write(&about(), flying()).unwrap()).unwrap();
        let mut old = metadata["flying"].take();
        old["format"] = json!("racer-policy-1");
        old["about"] = metadata["training"].take();
        assert_eq!(read(&old.to_string()).unwrap(), (1, about()));

        let mut metadata: Value = serde_json::from_str(&write(&about(), flying()).unwrap()).unwrap();
        assert_eq!(metadata["training"].get("seconds"), None);
        metadata["format"] = json!("racer-policy-2");
        metadata["training"]["seconds"] = json!(60.1);
        assert_eq!(read(&metadata.to_string()).unwrap(), (2, about()));
    }

    #[test]
    fn what_is_newer_or_foreign_is_refused_with_what_to_do() {
        let newer = refused(|m| {
            m["format"] = json!("racer-policy-4");
            m["racer"] = json!("9.8.7");
        });
        assert!(newer.contains("racer-policy-4") && newer.contains("use a racer as new as 9.8.7"), "{newer}");
        let key = refused(|m| m["training"]["env"]["reward"]["applause"] = json!(1.0));
        assert!(key.starts_with("training.env.reward") && key.contains("applause"), "{key}");
        let layout = refused(|m| m["flying"]["observation"][0]["scale"] = json!(0.2));
        assert!(layout.starts_with("flying.observation"), "{layout}");
        assert!(refused(|m| m["format"] = json!("other-3")).contains("other-3"));
    }
}
