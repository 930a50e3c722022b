//! Whether a training has room in memory, before it begins.

use crate::base::check::BadInput;
use crate::base::memory::{available, shown};
use crate::learn::policy::ACTIONS;
use crate::race::checkpoint::SavedBlock;
use crate::race::config::Setup;
use crate::race::env::observe::OBSERVATIONS;

/// Bytes that a training as `setup` says takes beyond the program itself: its rollout and its environments, twice for
/// the checkpoint.
pub fn needed(setup: &Setup) -> u64 {
    let ppo = &setup.config.ppo;
    // Observations, actions; log-probability, reward, value, last value, advantage, return; ends.
    let sample = 4 * (OBSERVATIONS + ACTIONS + 6) + 1;
    let environment = 2 * size_of::<SavedBlock>() / crate::base::lane::LANES;
    ppo.samples() as u64 * sample as u64 + (ppo.environments * environment) as u64
}

/// Refuses what would not fit.
pub fn check(setup: &Setup) -> Result<(), BadInput> {
    let (needed, Some(free)) = (needed(setup), available()) else { return Ok(()) };
    if needed <= free {
        return Ok(());
    }
    let ppo = &setup.config.ppo;
    let found = format!("{} x {} samples, {} of memory", ppo.environments, ppo.rollout, shown(needed));
    let expected = format!("at most the {} that are free", shown(free));
    Err(BadInput::new("ppo.environments x ppo.rollout", found, &expected, "lower one of them"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::race::config::Setting;

    #[test]
    fn what_does_not_fit_is_refused_with_its_size() {
        let setup = |text: &[&str]| {
            let settings: Vec<_> = text.iter().map(|s| Setting::parse(s).unwrap()).collect();
            Setup::load("a2rl", &settings).unwrap()
        };
        assert!(needed(&setup(&[])) < 20_000_000);
        assert!(check(&setup(&[])).is_ok());
        let large = setup(&["ppo.environments=1048576", "ppo.rollout=256", "ppo.minibatches=1024"]);
        assert!((40e9..80e9).contains(&(needed(&large) as f64)), "{}", needed(&large));
        if available().is_some_and(|free| free < 40_000_000_000) {
            let text = check(&large).unwrap_err().to_string();
            assert!(text.contains("1048576 x 256") && text.contains(" GB"), "{text}");
        }
    }
}
