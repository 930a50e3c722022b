//! A training of a policy: in its race, under its budget, with what it was trained on kept beside each policy.

use crate::base::lane::Level;
use crate::learn::ppo::train::{Observer, train as learn};
use crate::race::config::Setup;
use crate::race::env::Race;
use crate::race::env::tally::Tally;
use crate::race::snapshot::{About, Snapshot};

/// What a training leaves.
#[derive(Clone, Debug)]
pub struct TrainedPolicies {
    /// Evenly spread over the budget; the last is the final policy.
    pub policies: Vec<Snapshot>,
    /// Environment steps and time, s.
    pub steps: u64,
    pub seconds: f64,
    /// Whether the observer ended it before the budget did.
    pub stopped: bool,
}

/// Trains on the current rayon pool. The same set-up with a budget of steps gives the same policies on any number of
/// threads.
pub fn train(level: Level, setup: &Setup, observer: &mut dyn Observer<Tally>) -> TrainedPolicies {
    let Setup { config, track, vehicle } = setup;
    let race = Race::new(&config.env, track, vehicle, config.seed);
    let trained = learn(level, &race, &config.ppo, &config.budget, config.seed, observer);
    let about = |steps, seconds| About {
        track: track.clone(),
        vehicle: vehicle.clone(),
        env: config.env.clone(),
        eval: config.eval.clone(),
        seed: config.seed,
        steps,
        seconds,
    };
    let policies = trained.snapshots.into_iter();
    let policies = policies.map(|s| Snapshot { network: s.network, about: about(s.steps, s.seconds) }).collect();
    TrainedPolicies { policies, steps: trained.steps, seconds: trained.seconds, stopped: trained.stopped }
}
