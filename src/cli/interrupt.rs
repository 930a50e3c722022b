//! Ctrl-C: the first asks to come to an end, the second ends.

use crate::base::fsio;
use std::io::Read;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
/// What the first Ctrl-C is answered with; none where it ends the process.
static REMARK: Mutex<Option<&'static str>> = Mutex::new(None);

/// From now on Ctrl-C, SIGTERM and SIGHUP leave no temporary file behind. Where the system does not allow that, they
/// end the process as ever.
pub fn install() {
    // A file beyond what `ulimit -f` allows is an error of the write, told like a full disk, and no end without a word.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::<AtomicBool>::default());
    let _ = ctrlc::set_handler(|| {
        let remark = REMARK.lock().ok().and_then(|remark| *remark);
        match remark {
            Some(remark) if !ASKED.swap(true, Ordering::Relaxed) => super::tell(&format!("\n{remark}")),
            _ => end(),
        }
    });
}

/// From now on the first Ctrl-C (or SIGTERM) is answered with `remark` and remembered, and the second ends the process.
pub fn watch(remark: &'static str) {
    if let Ok(mut now) = REMARK.lock() {
        *now = Some(remark);
    }
}

fn end() -> ! {
    fsio::remove_temporaries();
    std::process::exit(130)
}

/// From now on this process ends where its standard input does. A pipe from the process that started it ends with that
/// process, however that ended.
pub fn end_with_standard_input() {
    std::thread::spawn(|| {
        let mut buffer = [0; 64];
        while std::io::stdin().read(&mut buffer).is_ok_and(|read| read > 0) {}
        end();
    });
}

/// Whether the user has asked to come to an end.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
