//! Keeping the pool's threads awake through many short parallel phases.

use std::sync::atomic::{AtomicBool, Ordering};

/// Looks for a job before the processor is offered to others: a tenth of a millisecond, longer than the sum of the
/// gradients and the optimiser's step take. A thread that offers its processor after every look is put behind all
/// others by the system, and on a busy machine its half of the update is then done by the one thread that does not.
const PATIENCE: usize = 2048;

/// Runs `work` while the other threads of the current rayon pool look for its jobs without ever going to sleep: waking
/// a thread takes as long as its half of a small minibatch. With more threads than processors they would only be in
/// each other's way, and nothing is done.
pub fn awake<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let Some(me) = rayon::current_thread_index() else { return work() };
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    if rayon::current_num_threads() > processors {
        return work();
    }
    let done = AtomicBool::new(false);
    rayon::scope(|scope| {
        // Each thread runs its own copy of a broadcast; this one's returns at once, or it could wait for itself.
        scope.spawn_broadcast(|_, thread| {
            let mut idle = 0;
            while thread.index() != me && !done.load(Ordering::Acquire) {
                if rayon::yield_now() == Some(rayon::Yield::Executed) {
                    idle = 0;
                } else {
                    idle += 1;
                    if idle % PATIENCE == 0 {
                        std::thread::yield_now();
                    }
                }
            }
        });
        let _end = End(&done);
        work()
    })
}

/// Lets the others go when `work` returns, and when it panics.
struct End<'a>(&'a AtomicBool);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}
