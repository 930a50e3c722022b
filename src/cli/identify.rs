//! `racer identify`: a vehicle from its flights.

use super::{CommandEnd, columns, logs, outputs, progress, tell};
use crate::base::check::{BadInput, Check};
use crate::base::encode;
use crate::flight::Options;
use crate::insight::identify::document::{CheckedLog, IdentificationDocument};
use crate::insight::identify::estimate::Estimated;
use crate::insight::identify::result::Identification;
use crate::insight::identify::{FORCE_CUTOFF_HZ, IdentifyOptions, RATE_CUTOFF_HZ, identify, refuse};
use crate::insight::quality::together;
use crate::model::vehicle::identified::ThrustSource;
use crate::model::vehicle::{AXES, Vehicle};
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
    /// Go on where a log contradicts itself, such as a rate that goes against its setpoint, or where logs contradict
    /// each other about their vehicle
    #[arg(long)]
    despite_problems: bool,
    /// Write a vehicle even where the logs tell no rates or no thrust: the base vehicle lends them
    #[arg(long)]
    partial: bool,
    /// New file for the vehicle that the figures are of: fitted on the first 70 % of the flight alone. `racer predict
    /// --part validation` makes the same figures of it
    #[arg(long, value_name = "V.toml")]
    validated: Option<PathBuf>,
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
`racer fly --pilot` shows such a flight. Give --mass and --full-rates where the log does not say them: forces and \
rates are theirs.

A number that does not predict the last 30 % of the flight is left to the base vehicle. Where that is all of the \
rates, or the thrust, no file is written, with exit code 2, unless --partial is given.

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
    let [out, json, page, validated] = outputs::reserve([
        ("--out", Some(&args.out)),
        ("--json", args.json.as_deref()),
        ("--report", args.report.as_deref()),
        ("--validated", args.validated.as_deref()),
    ])?;
    let bar = progress::bar();
    let checked = logs::read(&args.logs, Options { mapping: args.mapping.as_deref(), flight: args.flight }, &bar)?;
    together::flights(&checked)?;
    if !args.despite_problems {
        refuse::problems(&checked)?;
        refuse::mixed(&checked, &options)?;
    }
    let mut found = identify(checked.clone(), &options, &mut |step, share| {
        bar.set_position((100.0 * share) as u64);
        bar.set_message(step.to_string());
    });
    bar.finish_and_clear();
    let stem = args.out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    found.vehicle.name = args.name.clone().unwrap_or(stem);
    found.validated.name = format!("{}, training part", found.vehicle.name);

    super::print(&text(&found))?;
    refuse::nothing(&found, args.partial)?;
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
    if let Some(validated) = validated {
        let written = validated.write(encode::toml("the vehicle", &found.validated)?.as_bytes())?;
        tell(&format!("the vehicle that the figures are of in {}", written.display()));
    }
    if let Some(out) = out {
        let written = out.write(encode::toml("the vehicle", &found.vehicle)?.as_bytes())?;
        tell(&format!("vehicle in {0}: racer train --vehicle {0}", written.display()));
    }
    Ok(if logs::damaged(&checked) { CommandEnd::Damaged } else { CommandEnd::Done })
}

fn options(args: &Args) -> Result<IdentifyOptions, BadInput> {
    let options = IdentifyOptions {
        base: Vehicle::load(&args.base)?,
        mass_kg: args.mass,
        max_rate_rad_s: args.full_rates.map(|rates| rates.map(f64::to_radians)),
        rate_cutoff_hz: args.rate_cutoff,
        force_cutoff_hz: args.force_cutoff,
        partial: args.partial,
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
    let row = |(name, parameter, digits, unit): &(String, Estimated, usize, &str)| {
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
    let flown = thrust(found).map_or(String::new(), |text| format!("\n\n{text}"));
    format!("validated on the last 30 % of the flight\n\n{response}\n\n{values}{flown}{assumed}{remarks}")
}

/// The thrust in numbers that people know.
fn thrust(found: &Identification) -> Option<String> {
    let words = &found.thrust;
    let (hover, [low, high]) = (words.hover_throttle?, words.flown_throttle?);
    let small = words.full_n.value.is_some_and(|newtons| newtons < 10.0);
    let full = estimate(&words.full_n, if small { 3 } else { 1 });
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let mut text = format!(
        "hovers at {} throttle; full throttle {full} N, {:.1} times the weight; flown from {} to {} throttle",
        percent(hover),
        found.vehicle.thrust_to_weight(),
        percent(low),
        percent(high)
    );
    if high < 0.9 {
        text += &format!("; beyond {} not flown, the curve is carried on", percent(high));
    }
    text += &format!("\nthrust from the {}", words.source.name());
    if words.source == ThrustSource::Command {
        text += ", which a flight controller's mixer moves: motor outputs in the log tell more";
    }
    if let (Some(command), Some(r2)) = (words.command_lag_s, words.command_r2) {
        let rotors = estimate(&words.rotor_lag_s.times(1e3), 1);
        text += &format!(
            ": motor outputs follow the command in {:.1} ms (R2 {r2:.2}), rotors follow them in {rotors} ms",
            1e3 * command
        );
    }
    Some(text)
}

/// Value and interval, or why there is none.
fn estimate(estimate: &Estimated, digits: usize) -> String {
    match (estimate.value, estimate.interval(), &estimate.why) {
        (Some(value), Some([low, high]), _) => format!("{value:.digits$} ({low:.digits$} to {high:.digits$})"),
        // Longer reasons stand below the table.
        (Some(value), None, Some(why)) if why.chars().count() > 50 => format!("{value:.digits$} (not kept, see below)"),
        (Some(value), None, Some(why)) => format!("{value:.digits$} ({why})"),
        (Some(value), ..) => format!("{value:.digits$}"),
        (None, _, _) => "-".into(),
    }
}
