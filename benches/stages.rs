//! The stages of a training iteration, each alone on one thread: `cargo bench --bench stages`.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use racer::base::lane::Level;
use racer::learn::ppo::training::Training;
use racer::model::constants::CONTROL_S;
use racer::model::dynamics::{Craft, Factors, State};
use racer::model::sim::Batch;
use racer::race::config::{Config, Setup};
use racer::race::env::Race;

fn setup() -> (Config, Race) {
    let Setup { config, track, vehicle } = Setup::load("a2rl", &[]).expect("built in");
    let race = Race::new(&config.env, &track, &vehicle, 1);
    (config, race)
}

/// The equations of motion: 2048 vehicles, 32 steps.
fn physics(c: &mut Criterion) {
    let (_, race) = setup();
    let state = State::new([0.0; 3], [5.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0; 4], 23.0);
    let craft = Craft::new(&race.vehicle, &Factors::NOMINAL, CONTROL_S, state);
    let mut group = c.benchmark_group("physics");
    group.throughput(Throughput::Elements(2048 * 32));
    for level in Level::available() {
        let mut batch = Batch::new(&vec![craft.clone(); 2048]);
        let actions = vec![[0.1, -0.1, 0.0, race.hover_command as f32]; 2048];
        group.bench_function(level.to_string(), |b| b.iter(|| batch.advance(level, &actions, 32)));
    }
}

/// Rollout, and rollout with advantages and update, of the default configuration.
fn iteration(c: &mut Criterion) {
    let (config, race) = setup();
    let mut group = c.benchmark_group("iteration");
    group.sample_size(10).throughput(Throughput::Elements(config.ppo.samples() as u64));
    for level in Level::available() {
        let mut training = Training::new(level, &race, &config.ppo, 1);
        group.bench_function(format!("rollout/{level}"), |b| b.iter(|| training.collect(&race)));
        group.bench_function(format!("whole/{level}"), |b| b.iter(|| training.iterate(0.0)));
    }
}

fn on_one_thread(c: &mut Criterion) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool of the process");
    physics(c);
    iteration(c);
}

criterion_group!(benches, on_one_thread);
criterion_main!(benches);
