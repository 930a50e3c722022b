//! `racer report`: a folder as a page and figures.

mod study;

use super::{Outcome, tell};
use crate::check::BadInput;
use crate::fsio::{new_folder, write_new};
use crate::run;
use crate::study::folder::PLAN;
use std::path::{Path, PathBuf};

/// Draw the figures of a study, and one page with all of them
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// The folder of a study
    #[arg(value_name = "STUDY")]
    folder: PathBuf,
    /// New folder for page and figures [default: report/ in the folder, numbered where there is one]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const HELP: &str =
    "The page, report.html, needs nothing beside it; the figures in it are there as SVG files, too. A study under \
way is drawn as far as it is.

Example:
  racer report runs/cpu_configurations";

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
        Kind::Study => study::draw(&args.folder)?,
    };
    let out = args.out.clone().unwrap_or_else(|| run::free(&args.folder.join("report")));
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
    Study,
}

fn kind(folder: &Path) -> Result<Kind, BadInput> {
    let has = |name: &str| folder.join(name).is_file();
    const EXPECTED: &str = "the folder of a study, which has a plan.json";
    if has(PLAN) {
        return Ok(Kind::Study);
    }
    Err(match folder.is_dir() {
        true if has("config.toml") => {
            let advice = "its figures, lap.svg and training.svg, are in it already";
            BadInput::new(folder.display(), "the folder of a run", EXPECTED, advice)
        }
        true => BadInput::new(folder.display(), "another folder", EXPECTED, "`racer study` makes one"),
        false => BadInput::new(folder.display(), "nothing of that name", EXPECTED, "`racer study` makes one"),
    })
}
