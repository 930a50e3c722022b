//! How long work takes.

use std::hint::black_box;
use std::time::{Duration, Instant};

/// Seconds of the fastest of the calls that fit into `time`, at least two.
pub fn best<T>(time: Duration, mut work: impl FnMut() -> T) -> f64 {
    let started = Instant::now();
    let (mut best, mut rounds) = (f64::INFINITY, 0);
    while rounds < 2 || started.elapsed() < time {
        let begin = Instant::now();
        black_box(work());
        best = best.min(begin.elapsed().as_secs_f64());
        rounds += 1;
    }
    best
}
