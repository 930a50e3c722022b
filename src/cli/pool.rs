//! The threads that everything runs on.

use crate::present::run::provenance::processors;

/// Threads to use: those asked for, or all that this process may use.
pub fn threads(asked: Option<usize>) -> usize {
    asked.unwrap_or_else(processors)
}

/// The value of `--threads`.
pub fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 1..=1024) => Ok(threads),
        _ => Err("expected 1 to 1024".into()),
    }
}

/// A pool of so many threads, to run the work in.
pub fn pool(threads: usize) -> anyhow::Result<rayon::ThreadPool> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?)
}
