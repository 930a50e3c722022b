//! The threads that everything runs on.

use crate::base::error::{Error, Result};

/// Logical processors that this process may use.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Runs `work` on a pool of so many threads, all processors where none are named.
pub fn on<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T> {
    let threads = threads.unwrap_or_else(processors);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|error| Error::Failed(format!("{threads} threads could not be started: {error}")))?.install(work))
}
