//! The policy's and the critic's networks.

pub mod adam;
pub mod aligned;
pub mod bf16;
pub mod finish;
pub mod gemm;
pub mod init;
pub mod mlp;

use crate::base::lane::{LANES, Lane};
use crate::base::rng::Sequence;
use crate::learn::policy::ACTIONS;
use aligned::Aligned;
use gemm::{Exact, Precision};
use mlp::{Hidden, Layout};
use std::ops::Range;

/// Units of a hidden layer (paper section 4.5).
pub const HIDDEN: usize = 64;
/// Blocks and samples of a tile: what one pass through the policy works on while it stays in cache.
pub const TILE_BLOCKS: usize = 4;
pub const TILE_SAMPLES: usize = TILE_BLOCKS * LANES;

/// Actor, critic and the logarithm of the exploration noise, in one flat vector: actor, critic, log_std.
///
/// Its order is that of the kernels (see [`Layout`](mlp::Layout)), with zeros between the parts; [`Network::layer`] has
/// the order of the textbook.
#[derive(Clone, Debug, PartialEq)]
pub struct Network<E> {
    pub actor: Layout,
    pub critic: Layout,
    pub parameters: Aligned<E>,
}

/// One layer of a network in the order of the textbook: y = x W + b.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer<E> {
    /// `[inputs][outputs]`
    pub weights: Vec<E>,
    /// `[outputs]`
    pub biases: Vec<E>,
}

/// Activations of a pass through the policy.
#[derive(Clone)]
pub struct Scratch<E>(Hidden<E>);

impl<E: Copy + Default> Network<E> {
    /// All parameters zero, for observations of `inputs` numbers.
    pub fn zeros(inputs: usize) -> Self {
        let actor = Layout { inputs, outputs: ACTIONS, offset: 0 };
        let critic = Layout { inputs, outputs: 1, offset: actor.end() };
        let parameters = Aligned::zeros((critic.end() + ACTIONS).next_multiple_of(LANES));
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

    /// Layer 0, 1 or 2 (the head) of `shape`, which is this network's actor or critic.
    pub fn layer(&self, shape: &Layout, index: usize) -> Layer<E> {
        let p = &self.parameters;
        if index == 2 {
            let head = &p[shape.head()];
            let weights = (0..HIDDEN * shape.outputs).map(|i| head[i % shape.outputs * HIDDEN + i / shape.outputs]);
            return Layer { weights: weights.collect(), biases: p[shape.head_biases()].to_vec() };
        }
        let both = &p[if index == 0 { shape.first() } else { shape.second() }];
        let (weights, biases) = both.split_at(both.len() - HIDDEN);
        Layer { weights: weights.to_vec(), biases: biases.to_vec() }
    }

    /// The inverse of [`Network::layer`].
    ///
    /// # Panics
    /// If the layer has other dimensions.
    pub fn set_layer(&mut self, shape: &Layout, index: usize, layer: &Layer<E>) {
        let p = &mut self.parameters;
        if index == 2 {
            assert_eq!(layer.weights.len(), HIDDEN * shape.outputs);
            let head = &mut p[shape.head()];
            for (i, &w) in layer.weights.iter().enumerate() {
                head[i % shape.outputs * HIDDEN + i / shape.outputs] = w;
            }
            p[shape.head_biases()].copy_from_slice(&layer.biases);
        } else {
            let both = &mut p[if index == 0 { shape.first() } else { shape.second() }];
            let (weights, biases) = both.split_at_mut(both.len() - HIDDEN);
            weights.copy_from_slice(&layer.weights);
            biases.copy_from_slice(&layer.biases);
        }
    }

    /// Scratch for [`Network::forward`].
    pub fn scratch<L: Lane<Elem = E>>(&self) -> Scratch<E> {
        Scratch(Hidden::new(TILE_SAMPLES))
    }

    /// Mean action before squashing, `[4][64]`, and value, `[64]`, of a tile of observations `[inputs][64]`.
    #[inline(always)]
    pub fn forward<L: Lane<Elem = E>, P: Precision<L>>(
        &self,
        x: &[E],
        scratch: &mut Scratch<E>,
        mean: &mut [E],
        value: &mut [E],
    ) {
        self.actor_with::<L, P>(x, scratch, mean);
        self.forward_critic::<L, P>(x, scratch, value);
    }

    /// Mean action before squashing alone, `[4][64]`.
    #[inline(always)]
    pub fn forward_actor<L: Lane<Elem = E>>(&self, x: &[E], scratch: &mut Scratch<E>, mean: &mut [E]) {
        self.actor_with::<L, Exact>(x, scratch, mean);
    }

    #[inline(always)]
    fn actor_with<L: Lane<Elem = E>, P: Precision<L>>(&self, x: &[E], scratch: &mut Scratch<E>, mean: &mut [E]) {
        mlp::forward::<L, P>(&self.actor, &self.parameters, TILE_SAMPLES, TILE_SAMPLES, x, &mut scratch.0, mean);
    }

    /// Value alone, `[64]`.
    #[inline(always)]
    pub fn forward_critic<L: Lane<Elem = E>, P: Precision<L>>(
        &self,
        x: &[E],
        scratch: &mut Scratch<E>,
        value: &mut [E],
    ) {
        mlp::forward::<L, P>(&self.critic, &self.parameters, TILE_SAMPLES, TILE_SAMPLES, x, &mut scratch.0, value);
    }
}

impl Network<f32> {
    /// Moves every parameter toward that of `other` by this share of the way.
    pub fn toward(&mut self, other: &Self, share: f32) {
        self.parameters.iter_mut().zip(&other.parameters[..]).for_each(|(own, to)| *own += share * (to - *own));
    }

    /// Orthogonal weights, zero biases, `log_std` for every command.
    pub fn initialised(inputs: usize, log_std: f64, rng: &mut Sequence) -> Self {
        let mut network = Self::zeros(inputs);
        let p = &mut network.parameters;
        for (shape, head_gain) in [(&network.actor, 0.01), (&network.critic, 1.0)] {
            for layer in [shape.first(), shape.second()] {
                let weights = layer.start..layer.end - HIDDEN;
                init::orthogonal(&mut p[weights], HIDDEN, std::f64::consts::SQRT_2, rng);
            }
            init::orthogonal(&mut p[shape.head()], HIDDEN, head_gain, rng);
        }
        let log_stds = network.log_std_range();
        network.parameters[log_stds].fill(log_std as f32);
        network
    }
}
