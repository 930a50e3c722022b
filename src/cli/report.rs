//! `racer report`: a folder as a page and figures.

mod run;
mod study;

use super::{Outcome, tell};
use crate::base::check::BadInput;
use crate::base::fsio::{new_folder, write_new};
use crate::present::run::free;
use crate::present::run::metrics::METRICS;
use crate::present::study::folder::PLAN;
use std::path::{Path, PathBuf};

/// Draw the figures of a run or of a study, and one page with all of them
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// The folder of a run or of a study
    #[arg(value_name = "RUN|STUDY")]
    folder: PathBuf,
    /// Of a run: another one, whose commands are drawn beside
    #[arg(long, value_name = "RUN")]
    beside: Option<PathBuf>,
    /// New folder for page and figures [default: report/ in the folder, numbered where there is one]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const HELP: &str =
    "The page, report.html, needs nothing beside it; the figures in it are there as SVG files, too. A study under \
way is drawn as far as it is. The policy of a run is flown again: its lap from above, its commands, and how far randomised \
vehicles fly from the nominal one.

Examples:
  racer report runs/cpu_configurations
  racer report runs/weak --beside runs/strong";

/// The page's name.
const PAGE: &str = "report.html";

/// A page, and its figures by the names of their files.
pub struct Drawn {
    pub page: String,
    pub figures: Vec<(String, String)>,
}

/// Draws what the folder holds and writes it.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let drawn = match kind(&args.folder)? {
        Kind::Study if args.beside.is_some() => {
            let expected = "the folder of a run, whose commands another one's can stand beside";
            return Err(BadInput::new("--beside", "the folder of a study", expected, "name one of its runs").into());
        }
        Kind::Study => study::draw(&args.folder)?,
        Kind::Run => run::draw(&args.folder, args.beside.as_deref())?,
    };
    let out = args.out.clone().unwrap_or_else(|| free(&args.folder.join("report")));
    new_folder(&out)?;
    let write = |name: &str, text: &str| {
        let path = out.join(name);
        write_new(&path, text.as_bytes()).map_err(|e| anyhow::anyhow!("{} could not be written: {e}", path.display()))
    };
    for (name, svg) in &drawn.figures {
        write(name, svg)?;
    }
    write(PAGE, &drawn.page)?;
    tell(&format!("{} figures beside the page", drawn.figures.len()));
    super::print(&out.join(PAGE).display().to_string())?;
    Ok(Outcome::Done)
}

/// What a folder can hold.
enum Kind {
    Run,
    Study,
}

fn kind(folder: &Path) -> Result<Kind, BadInput> {
    let has = |name: &str| folder.join(name).is_file();
    const EXPECTED: &str = "the folder of a run or of a study";
    if has(PLAN) {
        return Ok(Kind::Study);
    }
    if has(METRICS) {
        return Ok(Kind::Run);
    }
    let found = if folder.is_dir() { "another folder" } else { "nothing of that name" };
    Err(BadInput::new(folder.display(), found, EXPECTED, "`racer train` and `racer study` make one"))
}
