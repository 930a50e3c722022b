//! Flight logs read and checked, for every command that learns from several.

use super::{findings, tell};
use crate::base::error::Result;
use crate::flight::{self, Readable};
use crate::insight::quality::{Quality, check};
use indicatif::ProgressBar;
use std::path::PathBuf;

/// The logs, checked; what was found is told beside `bar`.
pub fn read(paths: &[PathBuf], mapping: Option<&str>, bar: &ProgressBar) -> Result<Vec<Quality>> {
    let read = |path: &PathBuf| {
        bar.set_message(format!("reading {}", path.display()));
        let opened = flight::open_with(path, flight::Options { mapping, flight: None })?;
        let quality = check(&opened.log);
        bar.suspend(|| {
            tell(&opened.log.name);
            opened.remarks.iter().for_each(|remark| tell(remark));
            tell(&findings::findings(&quality.findings));
            tell(&format!("{}\n", findings::usable(&opened.log, &quality)));
        });
        Ok(quality)
    };
    paths.iter().map(read).collect()
}

/// Whether a file could not be read to its end.
pub fn damaged(logs: &[Quality]) -> bool {
    logs.iter().any(|quality| quality.log.readable != Readable::Whole)
}
