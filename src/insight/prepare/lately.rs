//! What was computed lately, for whoever asks for the same again: a fit comes back to where it stands.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// The latest few values, each of a key.
pub struct Lately<K, V> {
    most: usize,
    kept: Mutex<VecDeque<(K, Arc<V>)>>,
}

impl<K: PartialEq, V> Lately<K, V> {
    /// Nothing yet, and `most` values at most.
    pub fn new(most: usize) -> Self {
        Self { most, kept: Mutex::default() }
    }

    /// The value of `key`, which `make` would make.
    pub fn get(&self, key: K, make: impl FnOnce() -> V) -> Arc<V> {
        let kept = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, value)) = kept().iter().find(|(k, _)| *k == key) {
            return value.clone();
        }
        let value = Arc::new(make());
        let mut kept = kept();
        kept.truncate(self.most - 1);
        kept.push_front((key, value.clone()));
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_are_kept() {
        let lately = Lately::new(2);
        let made = std::cell::Cell::new(0);
        for (key, times) in [(1, 1), (1, 1), (2, 2), (1, 2), (3, 3), (1, 4), (3, 4)] {
            let value = lately.get(key, || {
                made.set(made.get() + 1);
                10 * key
            });
            assert_eq!((*value, made.get()), (10 * key, times), "after {key}");
        }
    }
}
