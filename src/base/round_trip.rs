//! How far apart the caches of two processors are.

use super::wait::wait;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

const TRIPS: usize = 4000;

/// Seconds in which a number goes from one thread to another and back, both awake, on average over a moment: some 60 ns
/// within a die, 300 and more between two.
pub fn round_trip_s() -> f64 {
    let number = AtomicUsize::new(0);
    let pass = |first: usize| {
        for turn in (first..2 * TRIPS).step_by(2) {
            wait(|| number.load(Ordering::Acquire) == turn);
            number.store(turn + 1, Ordering::Release);
        }
    };
    let started = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            started.store(true, Ordering::Release);
            pass(1);
        });
        wait(|| started.load(Ordering::Acquire));
        let begin = Instant::now();
        pass(0);
        wait(|| number.load(Ordering::Acquire) == 2 * TRIPS);
        begin.elapsed().as_secs_f64() / TRIPS as f64
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_number_comes_back() {
        let s = super::round_trip_s();
        assert!(s > 1e-9 && s.is_finite());
    }
}
