//! The network as named tensors.

use crate::base::check::Invalid;
use crate::learn::nn::mlp::Shape;
use crate::learn::nn::{HIDDEN, Layer, Network};
use crate::learn::policy::ACTIONS;
use crate::race::env::observe::OBSERVATIONS;
use safetensors::tensor::{Dtype, SafeTensors};

/// The networks by name.
fn networks(network: &Network<f32>) -> [(&'static str, Shape); 2] {
    [("actor", network.actor.clone()), ("critic", network.critic.clone())]
}

/// Names, shapes and numbers of the network's tensors.
pub fn of(network: &Network<f32>) -> Vec<(String, Vec<usize>, Vec<f32>)> {
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
pub fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// The numbers of a tensor, which must be finite and have this shape.
pub fn read(file: &SafeTensors, name: &str, shape: &[usize]) -> Result<Vec<f32>, Invalid> {
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
