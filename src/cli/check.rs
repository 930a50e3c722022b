//! `racer check`: what a flight log holds, and what is wrong with it.

use super::{CommandEnd, findings, tell};
use crate::flight::spans::Span;
use crate::flight::{self, FlightSummary, Options, Readable, VehicleRecord};
use crate::insight::quality::{LogFinding, ParameterCoverage, StreamSummary, check};
use serde::Serialize;
use std::path::PathBuf;

/// Say what a flight log holds, what is wrong with it, and which model parameters it can tell
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// A log: MCAP, Betaflight blackbox, PX4 ULog or CSV
    #[arg(value_name = "LOG")]
    log: PathBuf,
    /// What the log's fields mean: a mapping's name or file [default: the format's own, or the one that fits]
    #[arg(long, value_name = "NAME|FILE")]
    mapping: Option<String>,
    /// Which flight of a blackbox file, counted from 1 [default: the longest]
    #[arg(long, value_name = "N")]
    flight: Option<usize>,
    /// Print JSON in place of text
    #[arg(long)]
    json: bool,
}

const HELP: &str = "Exit code 3 means that the file is damaged and only its readable part was checked, 6 that \
something (PROBLEM) stops `racer identify` and `racer diagnose`.

Examples:
  racer check flight.mcap
  racer check flight.csv.gz --mapping indiflight
  racer check btfl_all.bbl --flight 3";

/// What `--json` prints.
#[derive(Serialize)]
struct CheckDocument<'a> {
    log: &'a str,
    vehicle: &'a VehicleRecord,
    flights: &'a [FlightSummary],
    streams: &'a [StreamSummary],
    findings: &'a [LogFinding],
    usable_s: &'a [Span],
    parameters: &'a [ParameterCoverage],
}

/// Reads, checks, prints.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let options = Options { mapping: args.mapping.as_deref(), flight: args.flight };
    let opened = flight::open_with(&args.log, options)?;
    opened.remarks.iter().for_each(|remark| tell(remark));
    let quality = check(&opened.log);
    if args.json {
        let document = CheckDocument {
            log: &opened.log.name,
            vehicle: &opened.log.vehicle,
            flights: &opened.flights,
            streams: &quality.streams,
            findings: &quality.findings,
            usable_s: &quality.usable,
            parameters: &quality.parameters,
        };
        super::print(&serde_json::to_string_pretty(&document)?)?;
    } else {
        super::print(&format!(
            "{}\n\n{}{}\n\n{}\n\n{}\n\n{}",
            opened.log.name,
            findings::flights(&opened.flights),
            findings::streams(&quality.streams),
            findings::findings(&quality.findings),
            findings::usable(&opened.log, &quality),
            findings::told(&quality.parameters)
        ))?;
    }
    Ok(match (quality.problem(), &opened.log.readable) {
        (Some(_), _) => CommandEnd::Problem,
        (None, Readable::Whole) => CommandEnd::Done,
        (None, _) => CommandEnd::Damaged,
    })
}
