//! Ctrl-C: the first asks to come to an end, the second ends.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on the first Ctrl-C (or SIGTERM) is remembered and the second ends the process.
pub fn watch() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        super::tell("\nFinishing this update and saving; Ctrl-C again ends at once, without saving.");
    })
}

/// Whether the user has asked to come to an end.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
