//! A short job that the threads at hand share.

use crate::base::wait::wait;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Parts of a job, which free threads take in their order, and its end, for which all wait awake: a pool that waits
/// asleep takes as long to wake as half a small minibatch does. A thread that comes late finds nothing to do.
pub struct SharedParts {
    parts: usize,
    next: AtomicUsize,
    done: AtomicUsize,
}

impl SharedParts {
    pub fn new(parts: usize) -> Self {
        Self { parts, next: AtomicUsize::new(0), done: AtomicUsize::new(0) }
    }

    /// Does parts as long as there are any that nobody has taken, and returns when all are done. A part may wait for
    /// those before it, which some thread is at.
    pub fn share(&self, mut work: impl FnMut(usize)) {
        loop {
            let part = self.next.fetch_add(1, Ordering::Relaxed);
            if part >= self.parts {
                break;
            }
            let _done = Done(&self.done);
            work(part);
        }
        wait(|| self.done.load(Ordering::Acquire) >= self.parts);
    }
}

/// Counts a part as done, and where it panics as well, or others would wait for ever.
struct Done<'a>(&'a AtomicUsize);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        self.0.fetch_add(1, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    #[test]
    fn each_part_is_done_once_before_anybody_goes_on() {
        let (parts, count) = (SharedParts::new(1000), AtomicUsize::new(0));
        let one = || {
            parts.share(|_| {
                count.fetch_add(1, Ordering::Relaxed);
            });
            assert_eq!(count.load(Ordering::Relaxed), 1000);
        };
        std::thread::scope(|scope| (0..4).for_each(|_| drop(scope.spawn(one))));
    }

    #[test]
    fn a_part_that_panics_keeps_nobody_waiting() {
        let parts = SharedParts::new(8);
        let all = |_| catch_unwind(AssertUnwindSafe(|| parts.share(|part| assert_ne!(part, 3)))).is_err();
        let failed = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..2).map(|i| scope.spawn(move || all(i))).collect();
            threads.into_iter().map(|thread| thread.join().expect("caught")).filter(|failed| *failed).count()
        });
        assert_eq!(failed, 1);
    }
}
