//! The report of a study.

use super::Drawn;
use crate::base::check::BadInput;
use crate::present::report::study;
use crate::present::study::curves;
use crate::present::study::folder::Folder;
use std::path::Path;

/// Page and figures of the study in `path`, as far as it is finished.
pub fn draw(path: &Path) -> anyhow::Result<Drawn> {
    let folder = Folder { path: path.into() };
    let results = folder.results()?;
    if results.finished() == 0 {
        let advice = "`racer study` goes on with it";
        return Err(BadInput::new(path.display(), "a study without a finished run", "at least one", advice).into());
    }
    let figures = study::figures(&results, &curves::read(&folder, &results)?)?;
    let page = study::page(&results, &figures);
    let named = figures.into_iter().map(|figure| (format!("{}.svg", figure.name), figure.svg));
    Ok(Drawn { page, figures: named.collect() })
}
