//! The report of a folder, whatever it holds: a run or a study.

use super::{Drawn, flown, study};
use crate::base::check::BadInput;
use crate::base::error::Result;
use crate::present::run::metrics::METRICS;
use crate::present::study::curves;
use crate::present::study::folder::{Folder, PLAN};
use std::path::Path;

/// What `folder` holds, drawn; of a run with the commands of the run in `beside` next to its own.
pub fn draw(folder: &Path, beside: Option<&Path>) -> Result<Drawn> {
    match (holds(folder)?, beside) {
        (Holds::Study, None) => study(folder),
        (Holds::Run, beside) => flown::draw(folder, beside),
        (Holds::Study, Some(_)) => {
            let expected = "the folder of a run, whose commands another one's can stand beside";
            Err(BadInput::new("--beside", "the folder of a study", expected, "name one of its runs").into())
        }
    }
}

/// What a folder can hold.
enum Holds {
    Run,
    Study,
}

fn holds(folder: &Path) -> Result<Holds, BadInput> {
    let has = |name: &str| folder.join(name).is_file();
    if has(PLAN) {
        return Ok(Holds::Study);
    }
    if has(METRICS) {
        return Ok(Holds::Run);
    }
    let expected = "the folder of a run or of a study";
    let found = if folder.is_dir() { "another folder" } else { "nothing of that name" };
    Err(BadInput::new(folder.display(), found, expected, "`racer train` and `racer study` make one"))
}

/// A study as far as it is finished.
fn study(path: &Path) -> Result<Drawn> {
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
