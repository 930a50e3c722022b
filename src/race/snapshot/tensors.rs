//! The network as named tensors.

use super::self_test::{SETPOINT, STATE, SelfTestRows};
use crate::base::check::Invalid;
use crate::learn::nn::mlp::Layout;
use crate::learn::nn::{HIDDEN, Layer, Network};
use crate::learn::policy::ACTIONS;
use crate::race::env::observe::OBSERVATIONS;
use safetensors::tensor::{Dtype, SafeTensors};

/// The networks by name.
fn networks(network: &Network<f32>) -> [(&'static str, Layout); 2] {
    [("actor", network.actor.clone()), ("critic", network.critic.clone())]
}

/// A named array of numbers of 32 bits.
#[derive(Clone, Debug)]
pub struct Tensor {
    pub name: String,
    pub kind: Dtype,
    pub shape: Vec<usize>,
    /// Little-endian, row after row.
    pub bytes: Vec<u8>,
}

impl Tensor {
    fn new(name: &str, shape: Vec<usize>, numbers: &[f32]) -> Self {
        Self { name: name.into(), kind: Dtype::F32, shape, bytes: bytes(numbers) }
    }

    /// The numbers.
    pub fn numbers(&self) -> Vec<f32> {
        let words = self.bytes.as_chunks().0.iter();
        match self.kind {
            Dtype::I32 => words.map(|&word| i32::from_le_bytes(word) as f32).collect(),
            _ => words.map(|&word| f32::from_le_bytes(word)).collect(),
        }
    }
}

/// The network's tensors.
pub fn of(network: &Network<f32>) -> Vec<Tensor> {
    let mut all = Vec::new();
    for (name, shape) in networks(network) {
        for index in 0..3 {
            let Layer { weights, biases } = network.layer(&shape, index);
            let outputs = biases.len();
            all.push(Tensor::new(&format!("{name}.{index}.weight"), vec![weights.len() / outputs, outputs], &weights));
            all.push(Tensor::new(&format!("{name}.{index}.bias"), vec![outputs], &biases));
        }
    }
    all.push(Tensor::new("log_std", vec![ACTIONS], &network.log_std()));
    all
}

/// The self-test's.
pub fn of_rows(rows: &SelfTestRows) -> Vec<Tensor> {
    let steps = rows.state.len();
    let target = rows.target.iter().flat_map(|target| target.to_le_bytes()).collect();
    vec![
        Tensor::new(STATES, vec![steps, STATE], rows.state.as_flattened()),
        Tensor { name: TARGETS.into(), kind: Dtype::I32, shape: vec![steps], bytes: target },
        Tensor::new(SEEN, vec![steps, OBSERVATIONS], rows.observation.as_flattened()),
        Tensor::new(ANSWERS, vec![steps, ACTIONS], rows.action.as_flattened()),
        Tensor::new(SETPOINTS, vec![steps, SETPOINT], rows.setpoint.as_flattened()),
    ]
}

const STATES: &str = "self_test.state";
const TARGETS: &str = "self_test.target";
const SEEN: &str = "self_test.observation";
const ANSWERS: &str = "self_test.action";
const SETPOINTS: &str = "self_test.setpoint";

/// What [`of_rows`] was made of.
pub fn read_rows(file: &SafeTensors) -> Result<SelfTestRows, Invalid> {
    let targets = file.tensor(TARGETS).map_err(|error| Invalid::new(TARGETS, error, "", ""))?;
    let fits = targets.dtype() == Dtype::I32 && targets.shape().len() == 1;
    Invalid::unless(fits, TARGETS, format!("{:?} of shape {:?}", targets.dtype(), targets.shape()), "", "")?;
    let steps = targets.shape()[0];
    Ok(SelfTestRows {
        state: read_table(file, STATES, steps)?,
        target: targets.data().as_chunks().0.iter().map(|&word| i32::from_le_bytes(word)).collect(),
        observation: read_table(file, SEEN, steps)?,
        action: read_table(file, ANSWERS, steps)?,
        setpoint: read_table(file, SETPOINTS, steps)?,
    })
}

/// Observations, and the actions that answer them.
type Answers = (Vec<[f32; OBSERVATIONS]>, Vec<[f32; ACTIONS]>);

/// The self-test of versions 1 and 2, which had nothing else.
pub fn read_answers(file: &SafeTensors) -> Result<Answers, Invalid> {
    const SAMPLES: usize = 8;
    Ok((read_table(file, SEEN, SAMPLES)?, read_table(file, ANSWERS, SAMPLES)?))
}

fn read_table<const N: usize>(file: &SafeTensors, name: &str, rows: usize) -> Result<Vec<[f32; N]>, Invalid> {
    Ok(read(file, name, &[rows, N])?.as_chunks().0.to_vec())
}

/// The network that [`of`] was made of.
pub fn read_network(file: &SafeTensors) -> Result<Network<f32>, Invalid> {
    let mut network = Network::zeros(OBSERVATIONS);
    for (name, shape) in networks(&network) {
        for index in 0..3 {
            let inputs = if index == 0 { shape.inputs } else { HIDDEN };
            let outputs = if index == 2 { shape.outputs } else { HIDDEN };
            let weights = read(file, &format!("{name}.{index}.weight"), &[inputs, outputs])?;
            let biases = read(file, &format!("{name}.{index}.bias"), &[outputs])?;
            network.set_layer(&shape, index, &Layer { weights, biases });
        }
    }
    let log_std = network.log_std_range();
    network.parameters[log_std].copy_from_slice(&read(file, "log_std", &[ACTIONS])?);
    Ok(network)
}

/// Little-endian.
fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// The numbers of a tensor, which must be finite and have this shape.
fn read(file: &SafeTensors, name: &str, shape: &[usize]) -> Result<Vec<f32>, Invalid> {
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
