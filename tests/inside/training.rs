//! Training as a whole: the same bits on any number of threads, and that it learns.

use racer::base::lane::Level;
use racer::learn::ppo::train::{Flow, Iteration, Observer, TrainedNetworks, train};
use racer::race::config::{Config, Setting};
use racer::race::env::Race;
use racer::race::env::tally::RaceTally;

#[derive(Default)]
struct Log {
    gates_per_episode: Vec<f64>,
    /// Stops after so many iterations, if not 0.
    stop_after: usize,
}

impl Observer<Race> for Log {
    fn iteration(&mut self, iteration: &Iteration<RaceTally>) -> Flow {
        self.gates_per_episode.push(iteration.tally.episode_gates / iteration.tally.episodes().max(1.0));
        if iteration.index == self.stop_after { Flow::Stop } else { Flow::Continue }
    }
}

fn run(threads: usize, level: Level, settings: &[&str], log: &mut Log) -> TrainedNetworks {
    let settings: Vec<_> = settings.iter().map(|s| Setting::parse(s).unwrap()).collect();
    let config = Config::load("a2rl", &settings).unwrap();
    let (track, vehicle) = (config.load_track().unwrap(), config.load_vehicle().unwrap());
    let race = Race::new(&config.env, &track, &vehicle, config.seed);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| train(level, &race, &config.ppo, &config.budget, config.seed, None, log))
}

fn bits(trained: &TrainedNetworks) -> Vec<u32> {
    trained.snapshots.last().unwrap().network.parameters.iter().map(|p| p.to_bits()).collect()
}

const SMALL: [&str; 5] =
    ["budget.steps=40000", "budget.snapshots=2", "ppo.environments=256", "ppo.rollout=16", "ppo.minibatches=4"];

/// One thread and five give the same policy to the last bit; another seed gives another.
#[test]
fn one_thread_is_many_threads_bit_for_bit() {
    for level in Level::available() {
        let one = run(1, level, &SMALL, &mut Log::default());
        let five = run(5, level, &SMALL, &mut Log::default());
        assert_eq!(bits(&one), bits(&five), "{level}");
        assert_eq!(one.steps, 40_960);
    }
    let seed = |seed: &str| bits(&run(2, Level::best(), &[&SMALL[..], &[seed]].concat(), &mut Log::default()));
    assert_ne!(seed("seed=1"), seed("seed=2"));
}

/// In bf16 as well, on whatever multiplies here; and it is another policy.
#[test]
fn in_bf16_too() {
    let settings = [&SMALL[..], &["ppo.precision='bf16'"]].concat();
    let [one, three] = [1, 3].map(|threads| bits(&run(threads, Level::best(), &settings, &mut Log::default())));
    assert_eq!(one, three);
    assert_ne!(one, bits(&run(2, Level::best(), &SMALL, &mut Log::default())));
}

/// Snapshots are spread over the budget, end with the final policy, and a stop ends the training with what there is.
#[test]
fn snapshots_and_stopping() {
    let all = run(2, Level::best(), &SMALL, &mut Log::default());
    assert_eq!(all.snapshots.len(), 2);
    assert_eq!(all.snapshots.last().unwrap().steps, all.steps);
    assert!(!all.stopped);
    let stopped = run(2, Level::best(), &SMALL, &mut Log { stop_after: 3, ..Log::default() });
    assert_eq!((stopped.steps, stopped.stopped), (3 * 256 * 16, true));
    assert_eq!(stopped.snapshots.last().unwrap().steps, stopped.steps);
}

/// A policy that is kept is the mean of the weights so far, where all of the iterations count.
#[test]
fn weights_are_averaged() {
    let kept = |average: &str| {
        let settings = [&SMALL[..], &["budget.snapshots=10", average]].concat();
        run(2, Level::best(), &settings, &mut Log::default()).snapshots
    };
    let [each, mean] = ["ppo.average=0", "ppo.average=1"].map(kept);
    assert_eq!((each.len(), mean.len()), (10, 10));
    for (i, averaged) in mean.last().unwrap().network.parameters.iter().enumerate() {
        let expected = each.iter().map(|taken| f64::from(taken.network.parameters[i])).sum::<f64>() / 10.0;
        assert!((f64::from(*averaged) - expected).abs() < 1e-5, "parameter {i}: {averaged} for {expected}");
    }
}

/// A million steps on the square more than double the gates passed in an episode.
#[test]
fn it_learns() {
    let mut log = Log::default();
    // Episodes that start anywhere, through gates as wide at first as at last: what is counted stays the same.
    let same = ["env.reset.retry_share=0", "env.reset.pad_share=0.15", "env.gate_radius_begin=1"];
    let size = ["track=square", "budget.steps=1000000", "ppo.environments=512", "ppo.rollout=32", "ppo.minibatches=16"];
    let settings = [&same[..], &size].concat();
    run(2, Level::best(), &settings, &mut log);
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let n = log.gates_per_episode.len();
    let (early, late) = (mean(&log.gates_per_episode[..n / 5]), mean(&log.gates_per_episode[n - n / 5..]));
    assert!(late > 2.0 * early, "{early} gates an episode at first, {late} at last");
}
