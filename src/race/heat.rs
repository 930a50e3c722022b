//! A few vehicles' races, step by step.

use crate::base::lane::{Kernel, LANES, Lane32, build};
use crate::base::rng::RngStream;
use crate::learn::nn::{Network, TILE_SAMPLES};
use crate::learn::policy::ACTIONS;
use crate::model::dynamics::{Craft, Factors};
use crate::race::env::observe::OBSERVATIONS;
use crate::race::env::reset::{self, StartPlace};
use crate::race::env::terminate::CAUSES;
use crate::race::env::{Block, Race};

/// Most vehicles that race side by side.
pub const MOST: usize = LANES;

/// Flies `network` in `vehicles` vehicles, at most [`MOST`], from number `first` on, for at most `steps` steps each.
/// Vehicle 0 is nominal; the others are those of an evaluation with the same seed.
pub struct Heat<'a> {
    pub race: &'a Race,
    pub network: &'a Network<f32>,
    /// Where the races begin.
    pub place: StartPlace,
    pub first: usize,
    pub vehicles: usize,
    pub steps: usize,
    /// Gates after which a race is over.
    pub gates: usize,
    /// Whether to keep what the policy saw.
    pub seen: bool,
}

/// One vehicle's race.
pub struct Raced {
    /// The vehicle at the beginning of each step, the command that was held through it, and the gate it flew to.
    pub steps: Vec<(Craft<f32>, [f32; ACTIONS], u32)>,
    /// What the policy saw at the beginning of each step, if that was asked for.
    pub seen: Vec<[f32; OBSERVATIONS]>,
    /// When each gate was passed, in order, s, interpolated within the step.
    pub passes: Vec<f64>,
    /// Index into [`CAUSES`] of why it failed.
    pub failure: Option<usize>,
}

impl Kernel for Heat<'_> {
    type Output = Vec<Raced>;

    #[inline(always)]
    fn run<L: Lane32>(self) -> Vec<Raced> {
        let Heat { race, network, place, first, vehicles, steps, gates, seen: keep } = self;
        let mut block: Block<L> = race.empty_block(0);
        let mut out = Vec::with_capacity(LANES);
        for lane in 0..LANES {
            // Lanes that nobody looks at fly as the first does.
            let vehicle = if lane < vehicles { first + lane } else { first };
            let mut rng = race.rng.sequence(RngStream::Evaluation, vehicle as u32, 0);
            let start = reset::draw(race, &mut rng, place, (vehicle == 0).then_some(Factors::NOMINAL));
            block.begin(race, lane, &start);
            out.push(Raced { steps: Vec::new(), seen: Vec::new(), passes: Vec::new(), failure: None });
        }
        out.truncate(vehicles);
        let mut seen = vec![0.0f32; OBSERVATIONS * TILE_SAMPLES];
        let mut scratch = network.scratch::<L>();
        let mut mean = [0.0f32; ACTIONS * TILE_SAMPLES];
        for step in 0..steps {
            if out.iter().all(|raced| over(raced, gates)) {
                break;
            }
            block.observe(race, &mut seen, TILE_SAMPLES);
            network.forward_actor::<L>(&seen, &mut scratch, &mut mean);
            let action: [L; ACTIONS] = build!(|k| L::from_slice(&mean[k * TILE_SAMPLES..]).tanh());
            for (lane, raced) in out.iter_mut().enumerate() {
                if !over(raced, gates) {
                    let craft = block.craft.map(|x| x.get(lane));
                    raced.steps.push((craft, action.map(|x| x.get(lane)), block.target[lane]));
                    if keep {
                        raced.seen.push(std::array::from_fn(|k| seen[k * TILE_SAMPLES + lane]));
                    }
                }
            }
            let outcome = block.step(race, action);
            for (lane, raced) in out.iter_mut().enumerate() {
                if over(raced, gates) {
                    continue;
                }
                if outcome.passed >> lane & 1 == 1 {
                    raced.passes.push((step as f64 + f64::from(outcome.fraction.get(lane))) * race.dt);
                }
                raced.failure = (0..CAUSES.len()).find(|&cause| outcome.causes[cause] >> lane & 1 == 1);
            }
        }
        out
    }
}

fn over(raced: &Raced, gates: usize) -> bool {
    raced.failure.is_some() || raced.passes.len() >= gates
}
