//! A policy on disk: the network as safetensors, with everything needed to fly it again in the same file.

mod describe;
mod metadata;
mod seen;
pub mod self_test;
mod tensors;

use crate::base::check::{BadInput, Check, Invalid};
use crate::base::error::Error;
use crate::base::fsio;
use crate::learn::nn::Network;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::race::env::observe::OBSERVATIONS;
use crate::race::env::{EnvConfig, Race};
use crate::race::eval::EvalConfig;
use crate::race::onboard::Surroundings;
use safetensors::tensor::{SafeTensors, TensorView, serialize};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::Path;

pub use self_test::SelfTestRows;
pub use tensors::Tensor;

/// A policy and where it comes from.
#[derive(Clone, Debug)]
pub struct Snapshot {
    pub network: Network<f32>,
    pub about: About,
}

/// What a policy was trained on and for how long.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct About {
    pub track: Track,
    pub vehicle: Vehicle,
    pub env: EnvConfig,
    pub eval: EvalConfig,
    pub seed: u64,
    /// Environment steps it was trained for.
    pub steps: u64,
    /// Training time, s. Not in the file: the same training is to give the same bytes.
    #[serde(skip)]
    pub seconds: f64,
}

impl Check for About {
    fn check(&self) -> Result<(), Invalid> {
        self.track.check().map_err(|invalid| invalid.within("track"))?;
        self.vehicle.check().map_err(|invalid| invalid.within("vehicle"))?;
        self.env.check().map_err(|invalid| invalid.within("env"))?;
        self.eval.check().map_err(|invalid| invalid.within("eval"))
    }
}

impl Snapshot {
    /// The race that the policy was trained for, in another vehicle if one is given, which the policy takes for its
    /// own.
    pub fn race(&self, vehicle: Option<&Vehicle>) -> Race {
        let About { track, vehicle: own, env, seed, .. } = &self.about;
        Race::new(env, track, vehicle.unwrap_or(own), *seed).seen_as(own)
    }

    /// Writes a new file. Weights are `[inputs][outputs]`; a layer is y = W' x + b, hidden ones followed by tanh.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        fsio::write_new(path, &self.to_bytes()?).map_err(Error::write(path))
    }

    /// Least and greatest of every entry of the observation in flights as in training.
    pub fn ranges(&self) -> [[f32; OBSERVATIONS]; 2] {
        seen::ranges(&self.race(None), &self.network)
    }

    /// What is in the file.
    pub fn content(&self) -> Result<PolicyContent, Error> {
        let About { track, vehicle, eval, .. } = &self.about;
        let flight = self_test::fly(&self.network, track, vehicle, eval.max_steps);
        let steps = self_test::window(&flight.steps);
        let flying = describe::flying(&describe::Shown {
            network: &self.network,
            about: &self.about,
            range: self.ranges(),
            steps,
            lap_s: flight.lap_s,
        });
        let metadata = metadata::write(&self.about, flying).map_err(Error::encode("the policy"))?;
        let rows = SelfTestRows::of(steps);
        let mut tensors = tensors::of(&self.network);
        tensors.extend(tensors::of_rows(&rows));
        Ok(PolicyContent { metadata, rows, tensors })
    }

    /// The file's content; the same policy always gives the same bytes.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        self.content()?.to_bytes()
    }

    /// [`Snapshot::to_bytes`], which are known to be read again: a network of numbers that are not finite has no file.
    pub fn checked_bytes(&self) -> Result<Vec<u8>, Error> {
        let bytes = self.to_bytes()?;
        match Self::from_bytes(&bytes) {
            Ok(_) => Ok(bytes),
            Err(Invalid { key, found, .. }) => Err(Error::encode("the policy")(format!("{key}: {found}"))),
        }
    }

    /// Reads a file, and makes sure that the network still answers as it did when it was written.
    pub fn read(path: &Path) -> Result<Self, BadInput> {
        let refuse = |found: String, advice: &str| {
            BadInput::new(path.display(), found, "a policy snapshot (.safetensors) of `racer train`", advice)
        };
        let bytes = std::fs::read(path).map_err(|error| refuse(error.to_string(), ""))?;
        Self::from_bytes(&bytes)
            .map_err(|Invalid { key, found, advice, .. }| refuse(format!("{key}: {found}"), &advice))
    }

    /// Reads the content of a file.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Invalid> {
        let (version, about) = read_about(bytes)?;
        let file = SafeTensors::deserialize(bytes).map_err(|error| Invalid::new("file", error, "", ""))?;
        let network = tensors::read_network(&file)?;
        if version < 3 {
            let (observations, actions) = tensors::read_answers(&file)?;
            self_test::check_network(&network, &observations, &actions)?;
        } else {
            tensors::read_rows(&file)?.check(&network, &Surroundings::of(&about.track, &about.vehicle))?;
        }
        Ok(Self { network, about })
    }
}

/// A policy's file before it becomes bytes.
#[derive(Clone, Debug)]
pub struct PolicyContent {
    /// JSON.
    pub metadata: String,
    pub rows: SelfTestRows,
    pub tensors: Vec<Tensor>,
}

impl PolicyContent {
    /// As safetensors.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        let views: Result<Vec<_>, _> = self
            .tensors
            .iter()
            .map(|t| Ok((&t.name, TensorView::new(t.kind, t.shape.clone(), &t.bytes)?)))
            .collect::<Result<_, safetensors::SafeTensorError>>();
        let metadata = HashMap::from([(METADATA.to_string(), self.metadata.clone())]);
        views.and_then(|views| serialize(views, Some(metadata))).map_err(Error::encode("the policy"))
    }
}

/// The metadata's only key: safetensors keeps no order among several, and files are to repeat bit for bit.
const METADATA: &str = "racer";

fn read_about(bytes: &[u8]) -> Result<(u32, About), Invalid> {
    let advice = "name a run folder, or a file in its snapshots/";
    let (_, header) = SafeTensors::read_metadata(bytes).map_err(|error| Invalid::new("file", error, "", advice))?;
    let text = header.metadata().as_ref().and_then(|map| map.get(METADATA));
    let text = text.ok_or_else(|| Invalid::new("metadata", format!("no entry `{METADATA}`"), "", advice))?;
    metadata::read(text).map_err(|invalid| invalid.within("metadata"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};
    use crate::race::config::Setup;

    fn snapshot() -> Snapshot {
        let Setup { config, track, vehicle } = Setup::load("a2rl", &[]).unwrap();
        let network = Network::initialised(OBSERVATIONS, -0.5, &mut Philox::new(3).sequence(RngStream::Weights, 0, 0));
        Snapshot {
            network,
            about: About { track, vehicle, env: config.env, eval: config.eval, seed: 3, steps: 7, seconds: 0.0 },
        }
    }

    #[test]
    fn what_is_written_is_what_is_read() {
        let written = snapshot();
        let bytes = written.to_bytes().unwrap();
        assert_eq!(bytes, written.to_bytes().unwrap());
        let read = Snapshot::from_bytes(&bytes).unwrap();
        assert_eq!(read.network, written.network);
        assert_eq!(read.about, written.about);
    }

    /// Version 2 kept eight random observations and the time of the training.
    #[test]
    fn a_file_of_version_2_is_read() {
        let written = snapshot();
        let mut content = written.content().unwrap();
        let mut metadata: serde_json::Value = serde_json::from_str(&content.metadata).unwrap();
        metadata["format"] = "racer-policy-2".into();
        metadata["training"]["seconds"] = 61.5.into();
        let names: Vec<_> =
            metadata["flying"]["action"].as_array().unwrap().iter().map(|a| a["name"].clone()).collect();
        metadata["flying"]["action"] = names.into();
        content.metadata = metadata.to_string();
        let answers = ["self_test.observation", "self_test.action"];
        content.tensors.retain(|t| !t.name.starts_with("self_test") || answers.contains(&t.name.as_str()));
        for t in content.tensors.iter_mut().filter(|t| t.name.starts_with("self_test")) {
            t.bytes.truncate(8 * t.shape[1] * 4);
            t.shape[0] = 8;
        }
        let read = Snapshot::from_bytes(&content.to_bytes().unwrap()).unwrap();
        assert_eq!((read.network, read.about), (written.network, written.about));
    }

    #[test]
    fn damaged_files_are_refused() {
        let bytes = snapshot().to_bytes().unwrap();
        // Somewhere in the first hidden layer of the actor.
        let mut changed = bytes.clone();
        let header = 8 + u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
        changed[header + 4000..header + 8000].fill(0x3f);
        let invalid = Snapshot::from_bytes(&changed).unwrap_err();
        assert!(invalid.key == "self_test.action", "{invalid:?}");
        for end in [0, 5, 100, bytes.len() - 1] {
            assert!(Snapshot::from_bytes(&bytes[..end]).is_err(), "{end}");
        }
    }
}
