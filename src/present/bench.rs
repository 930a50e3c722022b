//! How fast this machine simulates and trains, and how near that is to what it could do at best.
//!
//! Every figure is steps of single vehicles a second, the best of several rounds, each long enough to time.

pub mod threads;

use crate::base::lane::bf16::Bf16Unit;
use crate::base::lane::{Kernel, LANES, Lane32, Level, dispatch, each};
use crate::base::peak;
use crate::base::round_trip::round_trip_s;
use crate::base::stopwatch::best;
use crate::learn::nn::{HIDDEN, TILE_BLOCKS};
use crate::learn::policy::ACTIONS;
use crate::learn::ppo::Environment;
use crate::learn::ppo::config::ProductPrecision;
use crate::learn::ppo::training::Training;
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::{Craft, Factors, State};
use crate::model::sim::Batch;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::race::config::Config;
use crate::race::env::Race;
use rayon::prelude::*;
use serde::Serialize;
use std::hint::black_box;
use std::time::Duration;

/// A figure on one thread and on all.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Pair {
    pub one_thread: f64,
    pub all_threads: f64,
}

/// Shares of what the machine could do if it did multiply-adds only. Physics and environment are counted in operations,
/// for each of which a multiply-add could be done; rollout and training in the networks' multiply-adds, rollout with
/// the environment's operations. A stage that falls behind its earlier share has lost something, whatever the machine.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PeakShares {
    pub physics: Pair,
    pub environment: Pair,
    pub rollout: Pair,
    pub training: Pair,
}

/// The measured figures.
#[derive(Clone, Debug, Serialize)]
pub struct BenchFigures {
    /// The model alone ([`crate::model::dynamics::step`]), commands held for a rollout's length, 2048 vehicles a
    /// thread.
    pub physics_steps_per_s: Pair,
    /// The whole environment: physics, gates, reward, resets, observation and all noise, under held commands; no
    /// policy.
    pub environment_steps_per_s: Pair,
    /// The environment with the policy: what training collects experience with.
    pub rollout_steps_per_s: Pair,
    /// Full training: rollout, advantages and all epochs of the update.
    pub training_steps_per_s: Pair,
    /// Single-precision multiply-add peak, operations a second, measured between the rounds.
    pub peak_flops_per_s: Pair,
    /// Share of the peak that each stage reaches; see [`PeakShares`].
    pub peak_shares: PeakShares,
    /// Share of the peak that training reaches on all threads, counting the networks' multiply-adds and nothing else.
    pub training_peak_share: f64,
    /// The same on one thread.
    pub training_peak_share_one_thread: f64,
    /// Operations of one environment step of training.
    pub training_flops_per_step: f64,
    /// In which a number goes from one thread to another and back, s.
    pub round_trip_s: f64,
    pub threads: usize,
    pub simd: String,
}

/// Arithmetic of one step of a vehicle, each operation of a block counted once (a multiply-add too), loads and stores
/// not: the model alone, and the environment where nobody passes a gate or begins anew. A test counts them.
pub const PHYSICS_OPERATIONS: f64 = 162.0;
pub const ENVIRONMENT_OPERATIONS: f64 = 1007.0;

/// Operations of the networks for one environment step of training: one forward pass to collect it, and forward, weight
/// gradients and input gradients (not of the first layer) in every epoch, a multiply-add counted as two.
pub fn training_flops_per_step(observations: usize, epochs: usize) -> f64 {
    let network = |outputs: usize| {
        let upper = HIDDEN * HIDDEN + HIDDEN * outputs;
        let forward = observations * HIDDEN + upper;
        (forward, 2 * forward + upper)
    };
    let (actor, critic) = (network(ACTIONS), network(1));
    2.0 * ((actor.0 + critic.0) + epochs * (actor.1 + critic.1)) as f64
}

/// Measures for about `time` in all.
pub fn measure(
    config: &Config,
    track: &Track,
    vehicle: &Vehicle,
    level: Level,
    threads: usize,
    time: Duration,
) -> BenchFigures {
    let race = Race::new(&config.env, track, vehicle, config.seed);
    let part = time / 10;
    let on = |threads: usize| -> [f64; 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        pool.install(|| {
            let physics = physics(&race, level, threads, config.ppo.rollout, part);
            let environment = environment(&race, level, threads, config.ppo.rollout, part);
            let mut training = Training::new(level, &race, &config.ppo, config.seed);
            let batch = training.batch() as f64;
            let rollout = batch / best(part, || training.collect(&race));
            // The peak is taken before and after: clocks drift.
            let before = peak::flops_per_s(level, part / 2);
            let trained = batch / best(part, || training.iterate(0.0));
            [physics, environment, rollout, trained, before.max(peak::flops_per_s(level, part / 2))]
        })
    };
    let (one, all) = (on(1), on(threads));
    let pair = |i: usize| Pair { one_thread: one[i], all_threads: all[i] };
    let flops = training_flops_per_step(race.observations(), config.ppo.epochs);
    let share =
        |i: usize, flops: f64| Pair { one_thread: one[i] * flops / one[4], all_threads: all[i] * flops / all[4] };
    let forward = training_flops_per_step(race.observations(), 0);
    let peak_shares = PeakShares {
        physics: share(0, 2.0 * PHYSICS_OPERATIONS),
        environment: share(1, 2.0 * ENVIRONMENT_OPERATIONS),
        rollout: share(2, forward + 2.0 * ENVIRONMENT_OPERATIONS),
        training: share(3, flops),
    };
    BenchFigures {
        physics_steps_per_s: pair(0),
        environment_steps_per_s: pair(1),
        rollout_steps_per_s: pair(2),
        training_steps_per_s: pair(3),
        peak_flops_per_s: pair(4),
        peak_shares,
        training_peak_share: peak_shares.training.all_threads,
        training_peak_share_one_thread: peak_shares.training.one_thread,
        training_flops_per_step: flops,
        round_trip_s: round_trip_s(),
        threads,
        simd: match config.ppo.precision {
            ProductPrecision::F32 => level.to_string(),
            ProductPrecision::Bf16 => format!("{level}, bf16: {}", Bf16Unit::best()),
        },
    }
}

fn physics(race: &Race, level: Level, threads: usize, steps: usize, time: Duration) -> f64 {
    let n = 2048 * threads;
    let start = State::new([0.0; 3], [5.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0; 4], race.vehicle.battery.full_v);
    let craft = Craft::new(&race.vehicle, &Factors::NOMINAL, CONTROL_S, start);
    let mut batch = Batch::new(&vec![craft; n]);
    let actions: Vec<_> = (0..n).map(|i| [0.1, -0.1, 0.01 * (i % 10) as f32, race.hover_command as f32]).collect();
    (n * steps) as f64 / best(time, || batch.advance(level, &actions, steps))
}

fn environment(race: &Race, level: Level, threads: usize, steps: usize, time: Duration) -> f64 {
    let blocks = 2048 / LANES * threads;
    let mut saved: Vec<_> = (0..blocks).map(|b| race.start((b * LANES) as u32)).collect();
    let seconds = best(time, || {
        saved.par_chunks_mut(TILE_BLOCKS).for_each(|tile| dispatch(level, FlyBench { race, tile, steps }));
    });
    (blocks * LANES * steps) as f64 / seconds
}

struct FlyBench<'a> {
    race: &'a Race,
    tile: &'a mut [<Race as Environment>::Saved],
    steps: usize,
}

impl Kernel for FlyBench<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        let race = self.race;
        let mut seen = vec![0.0f32; race.observations() * LANES];
        let mut tally = Default::default();
        let action = each!([0.02, -0.02, 0.01, race.hover_command], |x| L::of(x));
        for saved in self.tile {
            let mut block = race.load::<L>(saved);
            for _ in 0..self.steps {
                race.observe(&block, &mut seen, LANES);
                black_box(&mut seen);
                let step = Environment::step(race, &mut block, action, &mut tally);
                race.reset(&mut block, step.terminated | step.truncated, &mut tally);
            }
            *saved = race.save(&block, &mut tally);
        }
        black_box(&tally);
    }
}
