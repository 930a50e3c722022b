//! Waiting for another thread without going to sleep.

/// Looks for the other's end before the processor is offered to others: some tens of microseconds.
const PATIENCE: usize = 1024;

/// Waits for what another thread is at.
pub fn wait(done: impl Fn() -> bool) {
    let mut looks = 0;
    while !done() {
        looks += 1;
        if looks % PATIENCE == 0 {
            std::thread::yield_now();
        } else {
            std::hint::spin_loop();
        }
    }
}
