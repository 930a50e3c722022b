//! Flight logs read and checked, for every command that learns from several.

use super::{findings, tell};
use crate::base::check::BadInput;
use crate::base::error::Result;
use crate::flight::{self, Options, Readable};
use crate::insight::quality::{Quality, check};
use indicatif::ProgressBar;
use std::path::PathBuf;

/// The logs, checked; what was found is told beside `bar`.
pub fn read(paths: &[PathBuf], options: Options, bar: &ProgressBar) -> Result<Vec<Quality>> {
    if options.flight.is_some() && paths.len() > 1 {
        let found = format!("{} logs", paths.len());
        let advice = "convert each with `racer import --flight N`, and give those";
        return Err(BadInput::new("--flight", found, "one log", advice).into());
    }
    let read = |path: &PathBuf| {
        bar.set_message(format!("reading {}", path.display()));
        let opened = flight::open_with(path, options)?;
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
