//! What a policy's network answers to observations, outside of the loops that fly it.

use crate::base::lane::{Kernel, Lane32, Level, dispatch};
use crate::learn::nn::{Network, TILE_SAMPLES};
use crate::learn::policy::ACTIONS;
use crate::race::env::observe::OBSERVATIONS;

/// Squashed mean actions to any number of observations.
pub fn act(network: &Network<f32>, observations: &[[f32; OBSERVATIONS]]) -> Vec<[f32; ACTIONS]> {
    let level = Level::best();
    let tiles = observations.chunks(TILE_SAMPLES).map(|tile| (tile.len(), dispatch(level, Forward { network, tile })));
    let action = |mean: &[f32], sample: usize| std::array::from_fn(|k| mean[k * TILE_SAMPLES + sample].tanh());
    tiles.flat_map(|(n, mean)| (0..n).map(move |sample| action(&mean, sample))).collect()
}

/// The network on a tile, which it takes whole and feature by feature.
struct Forward<'a> {
    network: &'a Network<f32>,
    tile: &'a [[f32; OBSERVATIONS]],
}

impl Kernel for Forward<'_> {
    type Output = [f32; ACTIONS * TILE_SAMPLES];

    #[inline(always)]
    fn run<L: Lane32>(self) -> Self::Output {
        let mut tile = vec![0.0; OBSERVATIONS * TILE_SAMPLES];
        for (sample, observation) in self.tile.iter().enumerate() {
            for (feature, &value) in observation.iter().enumerate() {
                tile[feature * TILE_SAMPLES + sample] = value;
            }
        }
        let mut mean = [0.0; ACTIONS * TILE_SAMPLES];
        self.network.forward_actor::<L>(&tile, &mut self.network.scratch::<L>(), &mut mean);
        mean
    }
}
