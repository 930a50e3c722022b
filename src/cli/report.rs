//! `racer report`: a folder as a page and figures.

use super::{CommandEnd, tell};
use crate::base::error::Error;
use crate::base::fsio::{new_folder, write_new};
use crate::present::report::folder::draw;
use crate::present::run::{folder, free};
use std::path::PathBuf;

/// Draw the figures of a run or of a study, and one page with all of them
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// The folder of a run or of a study, or `latest` for the youngest run below runs/
    #[arg(value_name = "RUN|STUDY|latest")]
    folder: PathBuf,
    /// Of a run: another one, whose commands are drawn beside
    #[arg(long, value_name = "RUN")]
    beside: Option<PathBuf>,
    /// New folder for page and figures [default: report/ in the folder, numbered where there is one]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const HELP: &str =
    "The page, report.html, needs nothing beside it; the figures in it are there as SVG files, too. A study under way \
is drawn as far as it is. The policy of a run is flown again: its lap from above, its commands, and how far randomised \
vehicles fly from the nominal one.

Examples:
  racer report latest
  racer report runs/cpu_configurations
  racer report runs/weak --beside runs/strong";

/// The page's name.
const PAGE: &str = "report.html";

/// Draws what the folder holds and writes it.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let of = folder(&args.folder)?;
    let drawn = draw(&of, args.beside.as_deref().map(folder).transpose()?.as_deref())?;
    let out = args.out.clone().unwrap_or_else(|| free(&of.join("report")));
    new_folder(&out, "--out")?;
    let write = |name: &str, text: &str| {
        let path = out.join(name);
        write_new(&path, text.as_bytes()).map_err(Error::write(&path))
    };
    for (name, svg) in &drawn.figures {
        write(name, svg)?;
    }
    write(PAGE, &drawn.page)?;
    tell(&format!("{} figures beside the page", drawn.figures.len()));
    super::print(&out.join(PAGE).display().to_string())?;
    Ok(CommandEnd::Done)
}
