//! A batch of vehicles without a race: struct of arrays in blocks of 16, on all cores.

use crate::base::lane::{Kernel, LANES, Lane, Lane32, Level, Portable, build, dispatch};
use crate::model::dynamics::Craft;
use rayon::prelude::*;

/// How a block rests in memory.
type Stored = Portable<f32>;

/// Vehicles side by side, in blocks of those that obey the same kind of equations.
#[derive(Clone, Debug)]
pub struct Batch {
    blocks: Vec<VehicleBlock>,
    /// Block and lane of each vehicle.
    places: Vec<(usize, usize)>,
}

#[derive(Clone, Debug)]
struct VehicleBlock {
    craft: Craft<Stored>,
    /// Which vehicle is in each lane. Lanes that are left over repeat the last one, and are never shown.
    vehicles: [usize; LANES],
}

impl Batch {
    /// A batch of `vehicles`, which keep their order.
    pub fn new(vehicles: &[Craft<f64>]) -> Self {
        let (extended, compact): (Vec<usize>, Vec<usize>) =
            (0..vehicles.len()).partition(|&i| vehicles[i].is_extended());
        let members: Vec<_> = compact.chunks(LANES).chain(extended.chunks(LANES)).collect();
        let mut places = vec![(0, 0); vehicles.len()];
        for (block, members) in members.iter().enumerate() {
            members.iter().enumerate().for_each(|(lane, &i)| places[i] = (block, lane));
        }
        let block = |members: &&[usize]| {
            let indices: [usize; LANES] = std::array::from_fn(|lane| members[lane.min(members.len() - 1)]);
            let mut craft = vehicles[indices[0]].map(|x| Stored::splat(x as f32));
            indices.iter().enumerate().for_each(|(lane, &i)| craft.set_lane(lane, &vehicles[i].map(|x| x as f32)));
            VehicleBlock { craft, vehicles: indices }
        };
        Batch { blocks: members.iter().map(block).collect(), places }
    }

    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Flies `steps` steps with the commands `actions[i]` of vehicle `i` held, on the current rayon pool.
    ///
    /// # Panics
    /// If there is not one action for each vehicle.
    pub fn advance(&mut self, level: Level, actions: &[[f32; 4]], steps: usize) {
        assert_eq!(actions.len(), self.len(), "one action for each vehicle");
        self.blocks.par_iter_mut().for_each(|block| dispatch(level, Advance { block, actions, steps }));
    }
}

/// What tests ask of a batch.
#[cfg(feature = "internals")]
impl Batch {
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// State of vehicle `i`.
    pub fn state(&self, i: usize) -> crate::model::dynamics::State<f32> {
        let (block, lane) = self.places[i];
        self.blocks[block].craft.state.map(|x| x.get(lane))
    }

    /// Vehicle `i` with all that moves it.
    pub fn craft(&self, i: usize) -> Craft<f32> {
        let (block, lane) = self.places[i];
        self.blocks[block].craft.map(|x| x.get(lane))
    }
}

struct Advance<'a> {
    block: &'a mut VehicleBlock,
    actions: &'a [[f32; 4]],
    steps: usize,
}

impl Kernel for Advance<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        let Advance { block, actions, steps } = self;
        let action = build!(|k| L::from_array(build!(|lane| actions[block.vehicles[lane]][k])));
        let mut craft = block.craft.map(|x| L::from_array(x.0));
        for _ in 0..steps {
            craft.step(action);
        }
        block.craft.resume(&craft, |x| Portable(x.to_array()));
    }
}
