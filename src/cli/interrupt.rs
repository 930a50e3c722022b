//! Ctrl-C: the first asks to come to an end, the second ends.

use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on the first Ctrl-C (or SIGTERM) is answered with `remark` and remembered, and the second ends the process.
pub fn watch(remark: &'static str) -> Result<(), ctrlc::Error> {
    let watching = ctrlc::set_handler(move || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        super::tell(&format!("\n{remark}"));
    });
    match watching {
        // A command that trains twice is watched since the first time.
        Err(ctrlc::Error::MultipleHandlers) => Ok(()),
        other => other,
    }
}

/// From now on this process ends where its standard input does. A pipe from the process that started it ends with that
/// process, however that ended.
pub fn end_with_standard_input() {
    std::thread::spawn(|| {
        let mut buffer = [0; 64];
        while std::io::stdin().read(&mut buffer).is_ok_and(|read| read > 0) {}
        std::process::exit(130);
    });
}

/// Whether the user has asked to come to an end.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
