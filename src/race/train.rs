//! A training of a policy: in its race, under its budget, with what it was trained on kept beside each policy.

use crate::base::lane::Level;
use crate::learn::ppo::state::Setback;
use crate::learn::ppo::train::{NetworkSnapshot, Observer, train as learn};
use crate::race::checkpoint::RaceState;
use crate::race::config::Setup;
use crate::race::env::Race;
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
    /// What ended it before either, in spite of setbacks.
    pub diverged: Option<Setback>,
}

/// The race that `setup` trains in.
pub fn race(setup: &Setup) -> Race {
    Race::new(&setup.config.env, &setup.track, &setup.vehicle, setup.config.seed)
}

/// The policy that was taken of a training as `setup` says.
pub fn policy_of(setup: &Setup, taken: &NetworkSnapshot) -> Snapshot {
    let Setup { config, track, vehicle } = setup;
    let about = About {
        track: track.clone(),
        vehicle: vehicle.clone(),
        env: config.env.clone(),
        eval: config.eval.clone(),
        seed: config.seed,
        steps: taken.steps,
        seconds: taken.seconds,
    };
    Snapshot { network: taken.network.clone(), about }
}

/// Trains on the current rayon pool, from the beginning or from `state`. The same set-up with a budget of steps gives
/// the same policies on any number of threads, whether it went on from a state or not.
pub fn train(
    level: Level,
    setup: &Setup,
    state: Option<&RaceState>,
    observer: &mut dyn Observer<Race>,
) -> TrainedPolicies {
    let config = &setup.config;
    let trained = learn(level, &race(setup), &config.ppo, &config.budget, config.seed, state, observer);
    TrainedPolicies {
        policies: trained.snapshots.iter().map(|taken| policy_of(setup, taken)).collect(),
        steps: trained.steps,
        seconds: trained.seconds,
        stopped: trained.stopped,
        diverged: trained.diverged,
    }
}
