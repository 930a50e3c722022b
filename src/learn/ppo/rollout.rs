//! Collecting experience: every tile of 64 environments flies the whole rollout on one thread, policy, environment and
//! resets included, while its state and activations stay in cache.

use super::config::ProductPrecision;
use super::{Environment, Step};
use crate::base::lane::{Bits, Kernel, LANES, Lane32, Level, build, dispatch, each};
use crate::base::rng::{Philox, RngStream, normals};
use crate::learn::nn::bf16::Bf16;
use crate::learn::nn::gemm::{Exact, Precision};
use crate::learn::nn::{Network, TILE_BLOCKS, TILE_SAMPLES};
use crate::learn::policy;
use rayon::prelude::*;

/// What a rollout of `T` steps gathers. A row is 16 environments at one step; rows lie `[tile][T][block of the tile]`,
/// and within a row numbers lie `[feature][16]`.
#[derive(Clone, Debug)]
pub struct Rollout {
    /// Rows of a tile: 4 T.
    pub tile_rows: usize,
    /// `[rows][observations][16]`
    pub observations: Vec<f32>,
    /// Unsquashed sampled actions, `[rows][4][16]`.
    pub z: Vec<f32>,
    /// `[rows][16]` each.
    pub log_prob: Vec<f32>,
    pub rewards: Vec<f32>,
    pub values: Vec<f32>,
    /// The critic at the last observation of a truncated episode, used only where `truncated`.
    pub final_values: Vec<f32>,
    /// Bit per lane, `[rows]`.
    pub terminated: Vec<u16>,
    pub truncated: Vec<u16>,
    /// The critic after the last step, `[tiles][4][16]`.
    pub last_values: Vec<f32>,
}

/// One tile's part of a [`Rollout`].
pub struct TileRows<'a> {
    pub observations: &'a mut [f32],
    pub z: &'a mut [f32],
    pub log_prob: &'a mut [f32],
    pub rewards: &'a mut [f32],
    pub values: &'a mut [f32],
    pub final_values: &'a mut [f32],
    pub terminated: &'a mut [u16],
    pub truncated: &'a mut [u16],
    pub last_values: &'a mut [f32],
}

impl Rollout {
    /// Room for `tiles` tiles of 64 environments over `steps` steps.
    pub fn new(tiles: usize, steps: usize, observations: usize) -> Self {
        let tile_rows = steps * TILE_BLOCKS;
        let rows = tiles * tile_rows;
        let lanes = vec![0.0; rows * LANES];
        Rollout {
            tile_rows,
            observations: vec![0.0; rows * observations * LANES],
            z: vec![0.0; rows * policy::ACTIONS * LANES],
            log_prob: lanes.clone(),
            rewards: lanes.clone(),
            values: lanes.clone(),
            final_values: lanes,
            terminated: vec![0; rows],
            truncated: vec![0; rows],
            last_values: vec![0.0; tiles * TILE_SAMPLES],
        }
    }

    /// The tiles' parts, in order.
    pub fn tiles(&mut self) -> Vec<TileRows<'_>> {
        let tiles = self.last_values.len() / TILE_SAMPLES;
        let (features, lanes) = (self.observations.len() / tiles, self.tile_rows * LANES);
        let mut observations = self.observations.chunks_exact_mut(features);
        let mut z = self.z.chunks_exact_mut(lanes * policy::ACTIONS);
        let mut log_prob = self.log_prob.chunks_exact_mut(lanes);
        let mut rewards = self.rewards.chunks_exact_mut(lanes);
        let mut values = self.values.chunks_exact_mut(lanes);
        let mut final_values = self.final_values.chunks_exact_mut(lanes);
        let mut terminated = self.terminated.chunks_exact_mut(self.tile_rows);
        let mut truncated = self.truncated.chunks_exact_mut(self.tile_rows);
        let last_values = self.last_values.chunks_exact_mut(TILE_SAMPLES);
        let mut next = move |last_values| {
            Some(TileRows {
                observations: observations.next()?,
                z: z.next()?,
                log_prob: log_prob.next()?,
                rewards: rewards.next()?,
                values: values.next()?,
                final_values: final_values.next()?,
                terminated: terminated.next()?,
                truncated: truncated.next()?,
                last_values,
            })
        };
        last_values.filter_map(&mut next).collect()
    }
}

impl TileRows<'_> {
    /// Keeps block `b` of the observations `seen` `[feature][64]` in `row`.
    #[inline(always)]
    fn keep_seen(&mut self, row: usize, b: usize, seen: &[f32]) {
        let features = seen.len() / TILE_SAMPLES;
        let out = &mut self.observations[row * features * LANES..][..features * LANES];
        for (out, seen) in out.chunks_exact_mut(LANES).zip(seen.chunks_exact(TILE_SAMPLES)) {
            out.copy_from_slice(&seen[b * LANES..][..LANES]);
        }
    }

    /// Keeps an action, its log-probability and the critic's `value` in `row`.
    #[inline(always)]
    fn keep_action<L: Lane32>(&mut self, row: usize, z: &[L; policy::ACTIONS], log_prob: L, value: &[f32]) {
        for (k, z) in z.iter().enumerate() {
            z.write(&mut self.z[(row * policy::ACTIONS + k) * LANES..]);
        }
        log_prob.write(&mut self.log_prob[row * LANES..]);
        self.values[row * LANES..][..LANES].copy_from_slice(value);
    }

    /// Keeps what came of it.
    #[inline(always)]
    fn keep_step<L: Lane32>(&mut self, row: usize, step: &Step<L>) {
        step.reward.write(&mut self.rewards[row * LANES..]);
        self.terminated[row] = step.terminated;
        self.truncated[row] = step.truncated;
    }
}

/// A tile of environments between rollouts.
#[derive(Clone)]
pub struct Tile<E: Environment> {
    /// Number of the tile's first environment.
    first: u32,
    saved: [E::Saved; TILE_BLOCKS],
    /// What happened in the last rollout.
    pub tally: E::Tally,
}

impl<E: Environment> Tile<E> {
    /// Tile number `index` with fresh episodes.
    pub fn new(environment: &E, index: usize) -> Self {
        let first = (index * TILE_SAMPLES) as u32;
        let saved = std::array::from_fn(|b| environment.start(first + (b * LANES) as u32));
        Tile { first, saved, tally: E::Tally::default() }
    }

    /// Its environments.
    pub fn saved(&self) -> &[E::Saved] {
        &self.saved
    }

    /// Goes on with the environments of the same tile.
    pub fn resume(&mut self, saved: &[E::Saved; TILE_BLOCKS]) {
        self.saved = saved.clone();
        self.tally = E::Tally::default();
    }
}

/// The stochastic policy that flies.
#[derive(Clone, Copy)]
pub struct Explorer<'a> {
    pub network: &'a Network<f32>,
    pub precision: ProductPrecision,
    pub rng: &'a Philox,
}

/// Flies `steps` steps in every tile under the stochastic policy, on the current rayon pool. `first_step` is the number
/// of steps flown before, part of the random numbers' counter.
pub fn collect<E: Environment>(
    level: Level,
    environment: &E,
    explorer: Explorer,
    tiles: &mut [Tile<E>],
    rollout: &mut Rollout,
    first_step: u32,
) {
    let steps = rollout.tile_rows / TILE_BLOCKS;
    tiles.par_iter_mut().zip(rollout.tiles()).for_each(|(tile, out)| {
        dispatch(level, Collect { environment, explorer, tile, out, steps, first_step });
    });
}

struct Collect<'a, E: Environment> {
    environment: &'a E,
    explorer: Explorer<'a>,
    tile: &'a mut Tile<E>,
    out: TileRows<'a>,
    steps: usize,
    first_step: u32,
}

impl<E: Environment> Kernel for Collect<'_, E> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lane32>(self) {
        match self.explorer.precision {
            ProductPrecision::F32 => self.fly::<L, Exact>(),
            ProductPrecision::Bf16 => self.fly::<L, Bf16>(),
        }
    }
}

impl<E: Environment> Collect<'_, E> {
    #[inline(always)]
    fn fly<L: Lane32, P: Precision<L>>(self) {
        let Collect { environment, explorer, tile, mut out, steps, first_step } = self;
        let Explorer { network, rng, .. } = explorer;
        let log_std = each!(network.log_std(), |s| L::splat(s));
        let mut blocks: [E::Block<L>; TILE_BLOCKS] = std::array::from_fn(|b| environment.load(&tile.saved[b]));
        let mut seen = vec![0.0f32; environment.observations() * TILE_SAMPLES];
        let mut scratch = network.scratch::<L>();
        let (mut mean, mut value) = ([0.0f32; policy::ACTIONS * TILE_SAMPLES], [0.0f32; TILE_SAMPLES]);
        tile.tally = E::Tally::default();

        for t in 0..steps {
            look(environment, &blocks, &mut seen);
            network.forward::<L, P>(&seen, &mut scratch, &mut mean, &mut value);
            let mut truncated_any = 0;
            for (b, block) in blocks.iter_mut().enumerate() {
                let row = t * TILE_BLOCKS + b;
                out.keep_seen(row, b, &seen);
                let mean = build!(|k| L::from_slice(&mean[k * TILE_SAMPLES + b * LANES..]));
                let noise = exploration::<L>(rng, tile.first + (b * LANES) as u32, first_step + t as u32);
                let (z, log_prob) = policy::sample(mean, log_std, noise);
                out.keep_action(row, &z, log_prob, &value[b * LANES..][..LANES]);
                let step = environment.step(block, each!(z, |z| z.tanh()), &mut tile.tally);
                out.keep_step(row, &step);
                truncated_any |= step.truncated;
            }
            // The critic sees where truncated episodes stopped, before they begin anew.
            if truncated_any != 0 {
                look(environment, &blocks, &mut seen);
                network.forward_critic::<L, P>(&seen, &mut scratch, &mut value);
                out.final_values[t * TILE_SAMPLES..(t + 1) * TILE_SAMPLES].copy_from_slice(&value);
            }
            for (b, block) in blocks.iter_mut().enumerate() {
                let row = t * TILE_BLOCKS + b;
                environment.reset(block, out.terminated[row] | out.truncated[row], &mut tile.tally);
            }
        }
        look(environment, &blocks, &mut seen);
        network.forward_critic::<L, P>(&seen, &mut scratch, out.last_values);
        for (saved, block) in tile.saved.iter_mut().zip(&blocks) {
            *saved = environment.save(block, &mut tile.tally);
        }
    }
}

/// The observations of a tile's blocks side by side, `[feature][64]`.
#[inline(always)]
fn look<E: Environment, L: Lane32>(environment: &E, blocks: &[E::Block<L>; TILE_BLOCKS], seen: &mut [f32]) {
    for (b, block) in blocks.iter().enumerate() {
        environment.observe(block, &mut seen[b * LANES..], TILE_SAMPLES);
    }
}

/// Standard normals for the actions of environments `first..first + 16` at `step`.
#[inline(always)]
fn exploration<L: Lane32>(rng: &Philox, first: u32, step: u32) -> [L; policy::ACTIONS] {
    let environments = L::Bits::from_array(build!(|i| first + i as u32));
    let w = rng.block(RngStream::Action, environments, step, 0);
    let ((n0, n1), (n2, n3)) = (normals::<L>(w[0], w[1]), normals::<L>(w[2], w[3]));
    [n0, n1, n2, n3]
}
