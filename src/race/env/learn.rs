//! The race as the learner sees it.

use super::observe::OBSERVATIONS;
use super::reset::{self, StartPlace};
use super::reward::TERMS;
use super::tally::RaceTally;
use super::{Block, Race, lanes};
use crate::base::lane::{LANES, Lane, Lane32, Portable, Real};
use crate::base::rng::RngStream;
use crate::learn::ppo::{Environment, Step};
use rand::RngExt;

impl Environment for Race {
    type Block<L: Lane32> = Block<L>;
    type Saved = Block<Portable<f32>>;
    type Tally = RaceTally;

    fn observations(&self) -> usize {
        OBSERVATIONS
    }

    fn start(&self, first: u32) -> Self::Saved {
        let mut block = self.empty_block::<Portable<f32>>(first);
        for lane in 0..LANES {
            self.restart(&mut block, lane, None);
            // The first episodes are of different ages, so that the horizon does not end them all at once.
            let mut rng = self.rng.sequence(RngStream::Reset, first + lane as u32, u32::MAX);
            block.clock.set(lane, rng.random_range(0..self.config.horizon_steps) as f32);
        }
        block
    }

    #[inline(always)]
    fn load<L: Lane32>(&self, saved: &Self::Saved) -> Block<L> {
        saved.map(|x| L::from_array(x.0))
    }

    #[inline(always)]
    fn save<L: Lane32>(&self, block: &Block<L>, tally: &mut RaceTally) -> Self::Saved {
        for (sum, term) in tally.terms.iter_mut().zip(block.terms) {
            *sum += f64::from(term.sum());
        }
        let mut saved = block.map(|x| Portable(x.to_array()));
        saved.terms = [Portable::of(0.0); TERMS.len()];
        saved
    }

    #[inline(always)]
    fn observe<L: Lane32>(&self, block: &Block<L>, out: &mut [f32], stride: usize) {
        Block::observe(block, self, out, stride);
    }

    #[inline(always)]
    fn step<L: Lane32>(&self, block: &mut Block<L>, action: [L; 4], tally: &mut RaceTally) -> Step<L> {
        let outcome = Block::step(block, self, action);
        tally.steps += LANES as f64;
        tally.gates += f64::from(outcome.passed.count_ones());
        for lane in lanes(outcome.passed) {
            let passed = block.passed[lane];
            tally.laps += f64::from(u8::from(passed > 1 && (passed - 1).is_multiple_of(self.gates.len() as u32)));
        }
        if outcome.terminated != 0 {
            for (count, lanes) in tally.causes.iter_mut().zip(outcome.causes) {
                *count += f64::from(lanes.count_ones());
            }
        }
        tally.truncated += f64::from(outcome.truncated.count_ones());
        let reward = L::select(outcome.reward.is_finite(), outcome.reward, L::zero());
        Step { reward, terminated: outcome.terminated as u16, truncated: outcome.truncated as u16 }
    }

    #[inline(always)]
    fn reset<L: Lane32>(&self, block: &mut Block<L>, ended: u16, tally: &mut RaceTally) {
        for lane in lanes(u32::from(ended)) {
            tally.returns.push(block.gathered.get(lane));
            tally.episode_gates += f64::from(block.passed[lane]);
            tally.episode_steps += f64::from(block.clock.get(lane));
            let failed = block.clock.get(lane) < self.config.horizon_steps as f32;
            self.restart(block, lane, failed.then_some(block.target[lane] as usize));
        }
    }

    fn at(&self, steps: u64, share: f64, penalties: f64) -> Self {
        let mut race = self.clone();
        let wide = self.config.widened(steps, share) as f32;
        race.gates.iter_mut().for_each(|gate| gate.radius *= wide);
        race.config.reward.action_change *= penalties;
        race
    }
}

impl Race {
    /// Begins a new episode after one that `failed` at that gate, if it did.
    fn restart<L: Lane32>(&self, block: &mut Block<L>, lane: usize, failed: Option<usize>) {
        let mut rng = self.rng.sequence(RngStream::Reset, block.first + lane as u32, block.step);
        let share = self.config.reset.retry_share;
        let place = match failed {
            Some(gate) if share > 0.0 && rng.random_bool(share) => StartPlace::Toward(gate),
            _ => StartPlace::Mixed,
        };
        let start = reset::draw(self, &mut rng, place, None);
        block.begin(self, lane, &start);
    }
}
