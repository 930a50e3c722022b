//! The name that a misspelt one was meant to be.

/// The candidate most like `name`; `None` where none is alike enough to be worth suggesting.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let last = |key: &'a str| key.rsplit('.').next().unwrap_or(key);
    let alike = |candidate: &'a str| {
        // `learning_rate` alone should find `ppo.learning_rate`.
        let short = strsim::jaro_winkler(name.rsplit('.').next().unwrap_or(name), last(candidate));
        let whole = strsim::jaro_winkler(name, candidate);
        0.6 * short + 0.4 * whole
    };
    let best = candidates.into_iter().map(|candidate| (alike(candidate), candidate)).max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(alike, _)| *alike > 0.7).map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn misspelt_and_misplaced_keys_are_found() {
        let keys = ["ppo.learning_rate", "ppo.lambda", "env.noise.rate_rad_s", "ppo.learning_rate_final"];
        assert_eq!(nearest("ppo.lerning_rate", keys), Some("ppo.learning_rate"));
        assert_eq!(nearest("learning_rate", keys), Some("ppo.learning_rate"));
        assert_eq!(nearest("zzz", keys), None);
    }
}
