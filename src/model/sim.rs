//! A batch of vehicles without a race: struct of arrays in blocks of 16, on all cores.

use crate::base::lane::{Kernel, LANES, Lane, Lane32, Level, Portable, build, dispatch};
use crate::model::dynamics::{Parameters, State, step};
use rayon::prelude::*;

/// How a block rests in memory.
type Rest = Portable<f32>;

/// Vehicles side by side. The last block is filled up with copies of the last vehicle, which are never shown.
#[derive(Clone, Debug)]
pub struct Batch {
    vehicles: usize,
    blocks: Vec<(State<Rest>, Parameters<Rest>)>,
}

impl Batch {
    /// A batch of `vehicles` states and parameters.
    pub fn new(vehicles: &[(State<f64>, Parameters<f64>)]) -> Self {
        let block = |chunk: &[(State<f64>, Parameters<f64>)]| {
            let (state, parameters) = &chunk[0];
            let mut block = (state.map(|x| Rest::splat(x as f32)), parameters.map(|x| Rest::splat(x as f32)));
            for lane in 0..LANES {
                let (state, parameters) = &chunk[lane.min(chunk.len() - 1)];
                block.0.set_lane(lane, &state.map(|x| x as f32));
                block.1.set_lane(lane, &parameters.map(|x| x as f32));
            }
            block
        };
        Batch { vehicles: vehicles.len(), blocks: vehicles.chunks(LANES).map(block).collect() }
    }

    pub fn len(&self) -> usize {
        self.vehicles
    }

    pub fn is_empty(&self) -> bool {
        self.vehicles == 0
    }

    /// State of vehicle `i`.
    pub fn state(&self, i: usize) -> State<f32> {
        assert!(i < self.vehicles);
        self.blocks[i / LANES].0.map(|x| x.get(i % LANES))
    }

    /// Flies `steps` steps with the commands `actions[i]` of vehicle `i` held, on the current rayon pool.
    ///
    /// # Panics
    /// If there is not one action for each vehicle.
    pub fn advance(&mut self, level: Level, actions: &[[f32; 4]], steps: usize) {
        assert_eq!(actions.len(), self.vehicles, "one action for each vehicle");
        self.blocks.par_iter_mut().zip(actions.par_chunks(LANES)).for_each(|(block, actions)| {
            dispatch(level, Advance { block, actions, steps });
        });
    }
}

struct Advance<'a> {
    block: &'a mut (State<Rest>, Parameters<Rest>),
    actions: &'a [[f32; 4]],
    steps: usize,
}

impl Kernel for Advance<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        let (state, parameters) = self.block;
        let lane = |lane: usize| self.actions[lane.min(self.actions.len() - 1)];
        let action = build!(|k| L::from_array(build!(|i| lane(i)[k])));
        let parameters = parameters.map(|x| L::from_array(x.0));
        let mut flying = state.map(|x| L::from_array(x.0));
        for _ in 0..self.steps {
            flying = step(&flying, &parameters, action);
        }
        *state = flying.map(|x| Portable(x.to_array()));
    }
}
