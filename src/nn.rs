//! The policy's and the critic's networks.

pub mod adam;
pub mod aligned;
pub mod gemm;
pub mod init;
pub mod mlp;

use crate::lane::{LANES, Lane};
use crate::policy::ACTIONS;
use crate::rng::Sequence;
use mlp::{Hidden, Shape};
use std::ops::Range;

/// Units of a hidden layer (paper section 4.5).
pub const HIDDEN: usize = 64;
/// Blocks and samples of a tile: what one pass through the network works on while it stays in cache.
pub const TILE_BLOCKS: usize = 4;
pub const TILE_SAMPLES: usize = TILE_BLOCKS * LANES;

/// Actor, critic and the logarithm of the exploration noise, in one flat vector: actor, critic, log_std.
#[derive(Clone, Debug, PartialEq)]
pub struct Network<E> {
    pub actor: Shape,
    pub critic: Shape,
    pub parameters: Vec<E>,
}

/// Activations of both networks.
#[derive(Clone)]
pub struct Scratch<E> {
    pub actor: Hidden<E>,
    pub critic: Hidden<E>,
}

impl<E: Copy + Default> Network<E> {
    /// All parameters zero, for observations of `inputs` numbers.
    pub fn zeros(inputs: usize) -> Self {
        let actor = Shape { inputs, outputs: ACTIONS, offset: 0 };
        let critic = Shape { inputs, outputs: 1, offset: actor.end() };
        let parameters = vec![E::default(); critic.end() + ACTIONS];
        Network { actor, critic, parameters }
    }

    /// Numbers in an observation.
    pub fn inputs(&self) -> usize {
        self.actor.inputs
    }

    /// Where log_std lies in the flat vector.
    pub fn log_std_range(&self) -> Range<usize> {
        self.critic.end()..self.critic.end() + ACTIONS
    }

    /// Logarithm of the exploration noise's standard deviation, per command.
    pub fn log_std(&self) -> [E; ACTIONS] {
        let at = self.critic.end();
        std::array::from_fn(|k| self.parameters[at + k])
    }

    /// Scratch for [`Network::forward`].
    pub fn scratch<L: Lane<Elem = E>>(&self) -> Scratch<E> {
        Scratch { actor: Hidden::default(), critic: Hidden::default() }
    }

    /// Mean action before squashing, `[4][64]`, and value, `[64]`, of a tile of observations `[inputs][64]`.
    #[inline]
    pub fn forward<L: Lane<Elem = E>>(&self, x: &[E], scratch: &mut Scratch<E>, mean: &mut [E], value: &mut [E]) {
        self.forward_actor::<L>(x, scratch, mean);
        mlp::forward::<L>(&self.critic, &self.parameters, x, &mut scratch.critic, value);
    }

    /// Mean action before squashing alone, `[4][64]`.
    #[inline]
    pub fn forward_actor<L: Lane<Elem = E>>(&self, x: &[E], scratch: &mut Scratch<E>, mean: &mut [E]) {
        mlp::forward::<L>(&self.actor, &self.parameters, x, &mut scratch.actor, mean);
    }
}

impl Network<f32> {
    /// Orthogonal weights, zero biases, `log_std` for every command.
    pub fn initialised(inputs: usize, log_std: f64, rng: &mut Sequence) -> Self {
        let mut network = Self::zeros(inputs);
        for (shape, head_gain) in [(network.actor.clone(), 0.01), (network.critic.clone(), 1.0)] {
            for layer in 0..3 {
                let gain = if layer == 2 { head_gain } else { std::f64::consts::SQRT_2 };
                let columns = shape.biases(layer).len();
                init::orthogonal(&mut network.parameters[shape.weights(layer)], columns, gain, rng);
            }
        }
        let log_stds = network.log_std_range();
        network.parameters[log_stds].fill(log_std as f32);
        network
    }
}
