//! How fast the machine simulates and trains: the work that is timed, and how.

use crate::config::Setup;
use crate::dynamics::{Factors, Parameters, State};
use crate::env::Race;
use crate::env::observe::OBSERVATIONS;
use crate::lane::{Kernel, LANES, Lane32, Level, dispatch};
use crate::nn::Network;
use crate::peak;
use crate::policy::ACTIONS;
use crate::ppo::Environment;
use crate::ppo::config::PpoConfig;
use crate::ppo::train::Training;
use crate::rng::{Philox, Stream};
use crate::run::provenance::processors;
use crate::sim::Batch;
use rayon::prelude::*;
use serde::Serialize;
use std::time::{Duration, Instant};

/// Steps that a call to [`Physics::run`] or [`Flying::run`] makes in each vehicle.
const STEPS: usize = 64;

/// Environment steps a second on one thread and on all.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Rate {
    pub one_thread: f64,
    pub all_threads: f64,
}

/// What a machine does.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// The dynamics alone: commands held, no noise, no observation, no track.
    pub physics_steps_per_s: Rate,
    /// The environment: observation, noise, dynamics, gates, reward, ends and resets, under a held command; no policy.
    pub environment_steps_per_s: Rate,
    /// The environment flown by the stochastic policy, everything stored for learning.
    pub rollout_steps_per_s: Rate,
    /// Rollout, advantages and all epochs of the update, as `racer train` does it.
    pub training_steps_per_s: Rate,
    /// Single-precision operations a second, all threads, a multiply-add counted as two.
    pub peak_flops_per_s: f64,
    /// Share of that which the networks' multiply-adds reach in training, all threads; everything else counts as nothing.
    pub training_peak_share: f64,
    pub threads: usize,
    pub simd: String,
}

/// Measures everything for about `time` a figure and thread count.
pub fn measure(setup: &Setup, level: Level, threads: usize, time: Duration) -> anyhow::Result<Figures> {
    let pools = [pool(1)?, pool(threads)?];
    let on_both = |run: &mut (dyn FnMut() -> u64 + Send)| {
        let [one_thread, all_threads] = [&pools[0], &pools[1]].map(|pool| pool.install(|| per_second(time, &mut *run)));
        Rate { one_thread, all_threads }
    };
    let race = Race::new(&setup.config.env, &setup.track, &setup.vehicle, setup.config.seed);
    let ppo = &setup.config.ppo;
    let (mut physics, mut flying) = (Physics::new(&race, ppo.environments), Flying::new(&race, ppo.environments));
    let mut training = Training::new(level, &race, ppo, setup.config.seed);
    let peak_flops_per_s = pools[1].install(|| peak::flops_per_s(level, time));
    let physics_steps_per_s = on_both(&mut || physics.run(level));
    let environment_steps_per_s = on_both(&mut || flying.run(level));
    let rollout_steps_per_s = on_both(&mut || {
        training.collect();
        training.batch() as u64
    });
    let training_steps_per_s = on_both(&mut || {
        training.iterate(0.0);
        training.batch() as u64
    });
    let training_peak_share = training_steps_per_s.all_threads * flop_per_step(ppo) / peak_flops_per_s;
    Ok(Figures {
        physics_steps_per_s,
        environment_steps_per_s,
        rollout_steps_per_s,
        training_steps_per_s,
        peak_flops_per_s,
        training_peak_share,
        threads,
        simd: level.to_string(),
    })
}

/// Threads to use: those asked for, or all that this process may use.
pub fn threads(asked: Option<usize>) -> usize {
    asked.unwrap_or_else(processors)
}

/// A thread pool; everything that runs in parallel is run in one.
pub fn pool(threads: usize) -> anyhow::Result<rayon::ThreadPool> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?)
}

/// Steps a second of `run`, which returns how many it made. The first call warms up and does not count.
fn per_second(time: Duration, run: &mut (dyn FnMut() -> u64 + Send)) -> f64 {
    run();
    let (started, mut steps) = (Instant::now(), 0);
    loop {
        steps += run();
        let elapsed = started.elapsed();
        if elapsed >= time {
            return steps as f64 / elapsed.as_secs_f64();
        }
    }
}

/// Operations of the networks' multiply-adds for one environment step of training: the policy and the critic once in the
/// rollout, and in each epoch forward, the gradient of every weight, and of every input but the first layer's.
pub fn flop_per_step(ppo: &PpoConfig) -> f64 {
    let Network { actor, critic, .. } = Network::<f32>::zeros(OBSERVATIONS);
    let weights = |shape: &crate::nn::mlp::Shape, from: usize| (from..3).map(|l| shape.weights(l).len()).sum::<usize>();
    let forward = weights(&actor, 0) + weights(&critic, 0);
    let inputs = weights(&actor, 1) + weights(&critic, 1);
    2.0 * (forward + ppo.epochs * (2 * forward + inputs)) as f64
}

/// Vehicles that fly, commands held.
pub struct Physics {
    batch: Batch,
    actions: Vec<[f32; ACTIONS]>,
}

impl Physics {
    pub fn new(race: &Race, vehicles: usize) -> Self {
        let mut rng = Philox::new(1).sequence(Stream::Evaluation, 0, 0);
        let state = State {
            position: [0.0; 3],
            velocity: [0.0; 3],
            attitude: [1.0, 0.0, 0.0, 0.0],
            command: [0.0; 4],
            voltage: race.vehicle.battery.full_v,
        };
        let parameters = Parameters::new(&race.vehicle, &Factors::NOMINAL, race.dt);
        let actions = (0..vehicles).map(|_| std::array::from_fn(|_| rng.uniform([-0.2, 0.2]) as f32)).collect();
        Self { batch: Batch::new(&vec![(state, parameters); vehicles]), actions }
    }

    /// Some steps on the current rayon pool; returns how many, over all vehicles.
    pub fn run(&mut self, level: Level) -> u64 {
        self.batch.advance(level, &self.actions, STEPS);
        (self.actions.len() * STEPS) as u64
    }
}

/// Environments that are flown with the thrust that carries the vehicle, and no policy.
pub struct Flying<'a> {
    race: &'a Race,
    blocks: Vec<(<Race as Environment>::Saved, <Race as Environment>::Tally)>,
}

impl<'a> Flying<'a> {
    pub fn new(race: &'a Race, environments: usize) -> Self {
        let firsts = (0..environments as u32).step_by(LANES);
        Self { race, blocks: firsts.map(|first| (race.start(first), Default::default())).collect() }
    }

    /// Some steps on the current rayon pool; returns how many, over all environments.
    pub fn run(&mut self, level: Level) -> u64 {
        let race = self.race;
        self.blocks.par_iter_mut().for_each(|block| dispatch(level, Fly { race, block }));
        (self.blocks.len() * LANES * STEPS) as u64
    }
}

struct Fly<'a> {
    race: &'a Race,
    block: &'a mut (<Race as Environment>::Saved, <Race as Environment>::Tally),
}

impl Kernel for Fly<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lane32>(self) {
        let (race, (saved, tally)) = (self.race, self.block);
        let mut block = race.load::<L>(saved);
        let action = [L::zero(), L::zero(), L::zero(), L::of(race.hover_command)];
        let mut seen = [0.0f32; OBSERVATIONS * LANES];
        *tally = Default::default();
        for _ in 0..STEPS {
            Environment::observe(race, &block, &mut seen, LANES);
            let step = Environment::step(race, &mut block, action, tally);
            race.reset(&mut block, step.terminated | step.truncated, tally);
            // Otherwise the compiler would see that nobody looks at the observation.
            std::hint::black_box(&seen);
        }
        *saved = race.save(&block);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::HIDDEN;

    /// With 41 observations: forward 41 x 64 + 64 x 64 + 64 x 4 and x 1, as counted by hand.
    #[test]
    fn operations_are_counted_as_by_hand() {
        let (actor, critic) = (41 * 64 + 64 * 64 + 64 * 4, 41 * 64 + 64 * 64 + 64);
        let inputs = (64 * 64 + 64 * 4) + (64 * 64 + 64);
        let ppo = Setup::load("a2rl", &[]).unwrap().config.ppo;
        assert_eq!((OBSERVATIONS, HIDDEN, ppo.epochs), (41, 64, 4));
        let expected = 2 * (actor + critic) + 4 * 2 * (2 * (actor + critic) + inputs);
        assert_eq!(flop_per_step(&ppo), expected as f64);
    }
}
