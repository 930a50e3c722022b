//! `racer identify`: a vehicle from its flights.

use super::{CommandEnd, columns, logs, progress, tell};
use crate::base::check::{BadInput, Check};
use crate::base::encode;
use crate::base::fsio::Reserved;
use crate::flight::Options;
use crate::insight::identify::document::{CheckedLog, IdentificationDocument};
use crate::insight::identify::estimate::Estimate;
use crate::insight::identify::result::Identification;
use crate::insight::identify::{AXES, FORCE_CUTOFF_HZ, IdentifyOptions, RATE_CUTOFF_HZ, identify, refuse};
use crate::model::vehicle::Vehicle;
use crate::present::report;
use std::path::PathBuf;

/// Identify a vehicle from flight logs
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Logs of one vehicle in the order of flight: MCAP, Betaflight blackbox, PX4 ULog or CSV
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// New file for the vehicle, which `racer train --vehicle` reads
    #[arg(long, value_name = "V.toml")]
    out: PathBuf,
    /// New file for everything that was found, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// New file for the report with figures, one page
    #[arg(long, value_name = "F.html")]
    report: Option<PathBuf>,
    /// What the logs' fields mean: a mapping's name or file [default: the format's own, or the one that fits]
    #[arg(long, value_name = "NAME|FILE")]
    mapping: Option<String>,
    /// Which flight of a blackbox file, counted from 1 [default: the longest]
    #[arg(long, value_name = "N")]
    flight: Option<usize>,
    /// Go on where a log contradicts itself, such as a rate that goes against its setpoint
    #[arg(long)]
    despite_problems: bool,
    /// Vehicle that lends what the logs cannot tell: a name or a file
    #[arg(long, value_name = "NAME|FILE", default_value = "seed_class")]
    base: String,
    /// What to call the vehicle [default: the name of the new file]
    #[arg(long)]
    name: Option<String>,
    /// Mass, kg [default: what the logs say, else the base vehicle's]
    #[arg(long, value_name = "KG", allow_negative_numbers = true)]
    mass: Option<f64>,
    /// Rates that a full stick asks for, deg/s: roll,pitch,yaw [default: what the logs say, else the base vehicle's]
    #[arg(long, value_name = "R,P,Y", value_parser = parse_rates)]
    full_rates: Option<[f64; 3]>,
    /// Cut-off of the zero-phase filter on measured and predicted rates, Hz
    #[arg(long, value_name = "HZ", default_value_t = RATE_CUTOFF_HZ, allow_negative_numbers = true)]
    rate_cutoff: f64,
    /// The same on specific force, where vibration is
    #[arg(long, value_name = "HZ", default_value_t = FORCE_CUTOFF_HZ, allow_negative_numbers = true)]
    force_cutoff: f64,
}

const HELP: &str =
    "The log is checked first; what is wrong with it, and what is done about that, is printed. Fly about five \
minutes: sharp steps on every stick, the whole throttle range, fast passes in every direction, climbs and descents. \
`racer fly --pilot` shows such a flight.

Exit code 3 means that a log is damaged and that its readable part was used.

Examples:
  racer identify flight.mcap --out mine.toml --report mine.html
  racer identify LOG00001.BFL --mass 0.68 --full-rates 700,700,400 --out mine.toml
  racer train --vehicle mine.toml";

fn parse_rates(text: &str) -> Result<[f64; 3], String> {
    let rates: Vec<f64> = text.split(',').filter_map(|rate| rate.trim().parse().ok()).collect();
    let rates: Result<[f64; 3], _> = rates.try_into();
    rates
        .ok()
        .filter(|rates| rates.iter().all(|r| *r > 0.0))
        .ok_or("expected three numbers above 0: roll,pitch,yaw".into())
}

/// Reads, checks, identifies, writes, prints.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let options = options(args)?;
    let reserve = |path: &Option<PathBuf>| path.as_deref().map(Reserved::new).transpose();
    let (out, json, page) = (Reserved::new(&args.out)?, reserve(&args.json)?, reserve(&args.report)?);
    let bar = progress::bar();
    let checked = logs::read(&args.logs, Options { mapping: args.mapping.as_deref(), flight: args.flight }, &bar)?;
    if !args.despite_problems {
        refuse::problems(&checked)?;
    }
    let mut found = identify(checked.clone(), &options, &mut |step, share| {
        bar.set_position((100.0 * share) as u64);
        bar.set_message(step.to_string());
    });
    bar.finish_and_clear();
    let stem = args.out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    found.vehicle.name = args.name.clone().unwrap_or(stem);

    super::print(&text(&found))?;
    refuse::nothing(&found)?;
    let documents = checked.iter().map(|quality| CheckedLog {
        name: &quality.log.name,
        streams: &quality.streams,
        findings: &quality.findings,
    });
    let documents: Vec<_> = documents.collect();
    if let Some(page) = page {
        let written = page.write(report::identification::page(&found, &documents)?.as_bytes())?;
        tell(&format!("report in {}", written.display()));
    }
    if let Some(json) = json {
        let document = encode::json("the identification", &IdentificationDocument::new(&found, documents))?;
        tell(&format!("figures in {}", json.write(document.as_bytes())?.display()));
    }
    let written = out.write(encode::toml("the vehicle", &found.vehicle)?.as_bytes())?;
    tell(&format!("vehicle in {0}: racer train --vehicle {0}", written.display()));
    Ok(if logs::damaged(&checked) { CommandEnd::Damaged } else { CommandEnd::Done })
}

fn options(args: &Args) -> Result<IdentifyOptions, BadInput> {
    let options = IdentifyOptions {
        base: Vehicle::load(&args.base)?,
        mass_kg: args.mass,
        max_rate_rad_s: args.full_rates.map(|rates| rates.map(f64::to_radians)),
        rate_cutoff_hz: args.rate_cutoff,
        force_cutoff_hz: args.force_cutoff,
    };
    options.check().map_err(|invalid| BadInput::at("command line", invalid))?;
    Ok(options)
}

/// The result as the paper's Table 1, and everything else below it.
fn text(found: &Identification) -> String {
    let digits = |value: Option<f64>, digits: usize| value.map_or("-".into(), |v| format!("{v:.digits$}"));
    let response = AXES.into_iter().chain(["thrust"]).zip(&found.response).map(|(name, r)| {
        vec![
            name.to_string(),
            estimate(&r.tau_s.times(1e3), 1),
            digits(r.rmse, 2),
            digits(r.mae, 2),
            r.unit.to_string(),
            digits(r.r2, 3),
            format!("{}/{}", r.n_train, r.n_validation),
        ]
    });
    let header = ["response", "tau, ms", "RMSE", "MAE", "", "R2", "samples"];
    let response = columns::table(&header, response.collect(), 1..4);
    let row = |(name, parameter, digits, unit): &(String, Estimate, usize, &str)| {
        vec![name.clone(), estimate(parameter, *digits), unit.to_string()]
    };
    let values = found.parameters().iter().map(row).collect();
    let values = columns::table(&["parameter", "value (95 % interval)", ""], values, 0..0);
    let assumed = found.vehicle.identified.iter().flat_map(|identified| &identified.assumed);
    let base = found.vehicle.identified.as_ref().map_or("", |identified| &identified.base);
    let assumed: String = assumed.map(|(key, why)| format!("\n  {key}: {why}")).collect();
    let assumed = if assumed.is_empty() { assumed } else { format!("\n\ntaken from the vehicle {base}{assumed}") };
    let remarks: String = found.remarks.iter().map(|remark| format!("\n  {remark}")).collect();
    let remarks = if remarks.is_empty() { remarks } else { format!("\n\nremarks{remarks}") };
    let flown = found.flown.map_or(String::new(), |[low, high]| {
        let ratio = found.vehicle.thrust_to_weight();
        let beyond = if high < 0.9 { ", extrapolated" } else { "" };
        format!(
            "\n\nthrust command flown from {low:.2} to {high:.2} (-1 to 1); full thrust is {ratio:.1} times the \
             weight{beyond}"
        )
    });
    format!("validated on the last 30 % of the flight\n\n{response}\n\n{values}{flown}{assumed}{remarks}")
}

/// Value and interval, or why there is none.
fn estimate(estimate: &Estimate, digits: usize) -> String {
    match (estimate.value, estimate.interval(), &estimate.why) {
        (Some(value), Some([low, high]), _) => format!("{value:.digits$} ({low:.digits$} to {high:.digits$})"),
        (Some(value), None, Some(why)) => format!("{value:.digits$} ({why})"),
        (Some(value), ..) => format!("{value:.digits$}"),
        (None, _, _) => "-".into(),
    }
}
