//! A policy on disk: the network as safetensors, with everything needed to fly it again in the same file.

mod self_test;

use crate::base::check::{BadInput, Check, Invalid};
use crate::base::error::Error;
use crate::base::fsio;
use crate::learn::nn::mlp::Shape;
use crate::learn::nn::{HIDDEN, Layer, Network};
use crate::learn::policy::ACTIONS;
use crate::model::constants::CONTROL_S;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::race::env::observe::{OBSERVATIONS, layout};
use crate::race::env::{EnvConfig, Race};
use crate::race::eval::EvalConfig;
use safetensors::tensor::{Dtype, SafeTensors, TensorView, serialize};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::Path;

/// Changes with every change that makes older files unreadable.
const FORMAT: &str = "racer-policy-1";
/// The metadata's only key: safetensors keeps no order among several, and files are to repeat bit for bit.
const METADATA: &str = "racer";

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
    /// Training time, s.
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

/// The metadata as it is written.
#[derive(Serialize, Deserialize)]
struct Metadata {
    format: String,
    /// Rate at which the policy is to be asked, Hz.
    control_rate_hz: f64,
    /// What goes in: [`layout`]. Kept as JSON, because a file may have been written by another version.
    observation: serde_json::Value,
    /// What comes out, after the tanh, each in [-1, 1].
    action: [String; ACTIONS],
    about: About,
}

impl Metadata {
    fn new(about: &About) -> Self {
        Self {
            format: FORMAT.into(),
            control_rate_hz: (1.0 / CONTROL_S).round(),
            observation: observation(&about.vehicle),
            action: ["roll rate", "pitch rate", "yaw rate", "collective thrust"].map(String::from),
            about: about.clone(),
        }
    }
}

fn observation(vehicle: &Vehicle) -> serde_json::Value {
    serde_json::to_value(layout(&vehicle.battery)).unwrap_or_default()
}

impl Snapshot {
    /// The race that the policy was trained for, in another vehicle if one is given, which the policy takes for its own.
    pub fn race(&self, vehicle: Option<&Vehicle>) -> Race {
        let About { track, vehicle: own, env, seed, .. } = &self.about;
        Race::new(env, track, vehicle.unwrap_or(own), *seed).seen_as(own)
    }

    /// Writes a new file. Weights are `[inputs][outputs]`; a layer is y = W' x + b, hidden ones followed by tanh.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        fsio::write_new(path, &self.to_bytes()?).map_err(Error::write(path))
    }

    /// The file's content; the same policy always gives the same bytes.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        let (observations, actions) = self_test::vectors(&self.network);
        let mut tensors: Vec<(String, Vec<usize>, Vec<u8>)> = tensors(&self.network)
            .into_iter()
            .map(|(name, shape, numbers)| (name, shape, bytes_of(&numbers)))
            .collect();
        let samples = self_test::SAMPLES;
        tensors.push(("self_test.observation".into(), vec![samples, OBSERVATIONS], bytes_of(&observations)));
        tensors.push(("self_test.action".into(), vec![samples, ACTIONS], bytes_of(&actions)));
        let views: Result<Vec<_>, _> = tensors
            .iter()
            .map(|(name, shape, bytes)| Ok((name, TensorView::new(Dtype::F32, shape.clone(), bytes)?)))
            .collect::<Result<_, safetensors::SafeTensorError>>();
        let metadata = serde_json::to_string(&Metadata::new(&self.about)).map_err(Error::encode("the policy"))?;
        let file = views.and_then(|views| serialize(views, Some(HashMap::from([(METADATA.into(), metadata)]))));
        file.map_err(Error::encode("the policy"))
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

    fn from_bytes(bytes: &[u8]) -> Result<Self, Invalid> {
        let about = read_about(bytes)?;
        let file = SafeTensors::deserialize(bytes).map_err(|error| Invalid::new("file", error, "", ""))?;
        let network = read_network(&file)?;
        let samples = self_test::SAMPLES;
        let observations = read_tensor(&file, "self_test.observation", &[samples, OBSERVATIONS])?;
        let actions = read_tensor(&file, "self_test.action", &[samples, ACTIONS])?;
        self_test::check(&network, &observations, &actions)?;
        Ok(Self { network, about })
    }
}

fn read_about(bytes: &[u8]) -> Result<About, Invalid> {
    let bad = |found: String| Invalid::new("metadata", found, "", "it was written by another program or version");
    let other = |error| Invalid::new("file", error, "", "name a run folder, or a file in its snapshots/");
    let (_, header) = SafeTensors::read_metadata(bytes).map_err(other)?;
    let text = header.metadata().as_ref().and_then(|map| map.get(METADATA));
    let text = text.ok_or_else(|| bad(format!("no `{METADATA}` entry")))?;
    let metadata: Metadata = serde_json::from_str(text).map_err(|error| bad(error.to_string()))?;
    if metadata.format != FORMAT {
        return Err(bad(format!("format {}, not {FORMAT}", metadata.format)));
    }
    if metadata.observation != observation(&metadata.about.vehicle) {
        return Err(bad("another observation layout than this version's".into()));
    }
    metadata.about.check().map_err(|invalid| invalid.within("metadata.about"))?;
    Ok(metadata.about)
}

/// The networks by name.
fn networks(network: &Network<f32>) -> [(&'static str, Shape); 2] {
    [("actor", network.actor.clone()), ("critic", network.critic.clone())]
}

/// Names, shapes and numbers of the network's tensors.
fn tensors(network: &Network<f32>) -> Vec<(String, Vec<usize>, Vec<f32>)> {
    let mut all = Vec::new();
    for (name, shape) in networks(network) {
        for index in 0..3 {
            let Layer { weights, biases } = network.layer(&shape, index);
            let outputs = biases.len();
            all.push((format!("{name}.{index}.weight"), vec![weights.len() / outputs, outputs], weights));
            all.push((format!("{name}.{index}.bias"), vec![outputs], biases));
        }
    }
    all.push(("log_std".into(), vec![ACTIONS], network.log_std().to_vec()));
    all
}

/// The network that [`tensors`] was made of.
fn read_network(file: &SafeTensors) -> Result<Network<f32>, Invalid> {
    let mut network = Network::zeros(OBSERVATIONS);
    for (name, shape) in networks(&network) {
        for index in 0..3 {
            let inputs = if index == 0 { shape.inputs } else { HIDDEN };
            let outputs = if index == 2 { shape.outputs } else { HIDDEN };
            let weights = read_tensor(file, &format!("{name}.{index}.weight"), &[inputs, outputs])?;
            let biases = read_tensor(file, &format!("{name}.{index}.bias"), &[outputs])?;
            network.set_layer(&shape, index, &Layer { weights, biases });
        }
    }
    let log_std = network.log_std_range();
    network.parameters[log_std].copy_from_slice(&read_tensor(file, "log_std", &[ACTIONS])?);
    Ok(network)
}

fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn read_tensor(file: &SafeTensors, name: &str, shape: &[usize]) -> Result<Vec<f32>, Invalid> {
    let tensor = file.tensor(name).map_err(|error| Invalid::new(name, error, "", ""))?;
    if tensor.dtype() != Dtype::F32 || tensor.shape() != shape {
        let found = format!("{:?} of shape {:?}, not F32 of {shape:?}", tensor.dtype(), tensor.shape());
        return Err(Invalid::new(name, found, "", ""));
    }
    let numbers = tensor.data().chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let numbers: Vec<f32> = numbers.collect();
    Invalid::unless(numbers.iter().all(|x| x.is_finite()), name, "numbers that are not finite", "", "")?;
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, Stream};
    use crate::race::config::Setup;

    fn snapshot() -> Snapshot {
        let Setup { config, track, vehicle } = Setup::load("a2rl", &[]).unwrap();
        let network = Network::initialised(OBSERVATIONS, -0.5, &mut Philox::new(3).sequence(Stream::Weights, 0, 0));
        Snapshot {
            network,
            about: About { track, vehicle, env: config.env, eval: config.eval, seed: 3, steps: 7, seconds: 0.1 },
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
