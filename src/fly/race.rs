//! One nominal vehicle's race from the pad, step by step.

use crate::dynamics::{Factors, State};
use crate::env::observe::OBSERVATIONS;
use crate::env::reset::{self, Place};
use crate::env::terminate::CAUSES;
use crate::env::{Block, Race};
use crate::lane::{Kernel, LANES, Lane32, build};
use crate::nn::{Network, TILE_SAMPLES};
use crate::policy::ACTIONS;
use crate::rng::Stream;

/// Flies `network` for at most `steps` steps.
pub struct Fly<'a> {
    pub race: &'a Race,
    pub network: &'a Network<f32>,
    pub steps: usize,
}

/// A race.
pub struct Raced {
    /// State at the beginning of each step, and the command that was held through it.
    pub steps: Vec<(State<f32>, [f32; ACTIONS])>,
    /// When each gate was passed, in order, s, interpolated within the step.
    pub passes: Vec<f64>,
    /// Index into [`CAUSES`] of why it failed.
    pub failure: Option<usize>,
}

impl Kernel for Fly<'_> {
    type Output = Raced;

    #[inline(always)]
    fn run<L: Lane32>(self) -> Raced {
        let Fly { race, network, steps } = self;
        let mut block: Block<L> = race.empty_block(0);
        let mut rng = race.rng.sequence(Stream::Evaluation, 0, 0);
        let start = reset::draw(race, &mut rng, Place::Pad, Some(Factors::NOMINAL));
        // All lanes fly the same race; the first is looked at.
        for lane in 0..LANES {
            block.begin(race, lane, &start);
        }
        let mut seen = vec![0.0f32; OBSERVATIONS * TILE_SAMPLES];
        let mut scratch = network.scratch::<L>();
        let mut mean = [0.0f32; ACTIONS * TILE_SAMPLES];
        let mut out = Raced { steps: Vec::new(), passes: Vec::new(), failure: None };
        for step in 0..steps {
            block.observe(race, &mut seen, TILE_SAMPLES);
            network.forward_actor::<L>(&seen, &mut scratch, &mut mean);
            let action: [L; ACTIONS] = build!(|k| L::from_slice(&mean[k * TILE_SAMPLES..]).tanh());
            out.steps.push((block.state.map(|x| x.get(0)), action.map(|x| x.get(0))));
            let outcome = block.step(race, action);
            if outcome.passed & 1 == 1 {
                out.passes.push((step as f64 + f64::from(outcome.fraction.get(0))) * race.dt);
            }
            out.failure = (0..CAUSES.len()).find(|&cause| outcome.causes[cause] & 1 == 1);
            if out.failure.is_some() {
                break;
            }
        }
        out
    }
}
