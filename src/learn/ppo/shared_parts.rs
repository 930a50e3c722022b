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
