//! `racer predict`: a finished vehicle applied to flights, without fitting anything.

use super::{CommandEnd, columns, logs, progress, tell};
use crate::base::check::{BadInput, Check};
use crate::base::encode;
use crate::base::error::Result;
use crate::base::fsio::Reserved;
use crate::flight::Options;
use crate::insight::identify::{FORCE_CUTOFF_HZ, IdentifyOptions, RATE_CUTOFF_HZ};
use crate::insight::predict::rms_change::RmsChange;
use crate::insight::predict::{PredictOptions, Prediction, predict};
use crate::insight::prepare::data::{Data, DataPart};
use crate::insight::quality::together;
use crate::model::vehicle::Vehicle;
use crate::present::predict::{csv, mcap};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Hold a vehicle against flight logs: measured, predicted and residual, without fitting anything
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Logs in the order of flight: MCAP, Betaflight blackbox, PX4 ULog or CSV
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Vehicle, compact or extended: a name or a file; a second one is compared on the same samples
    #[arg(long = "vehicle", required = true, value_name = "NAME|FILE")]
    vehicles: Vec<String>,
    /// New file of all signals: .csv, or .mcap for Foxglove
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Which of the usable samples: the first 70 %, which `racer identify` learns from, or the rest
    #[arg(long, value_enum, default_value = "all")]
    part: FlightPart,
    /// Print JSON in place of text, with all digits
    #[arg(long)]
    json: bool,
    /// What the logs' fields mean: a mapping's name or file [default: the format's own, or the one that fits]
    #[arg(long, value_name = "NAME|FILE")]
    mapping: Option<String>,
    /// Which flight of a file with several, counted from 1 [default: the longest]
    #[arg(long, value_name = "N")]
    flight: Option<usize>,
    /// Cut-off of the zero-phase filter on measured and predicted rates, Hz
    #[arg(long, value_name = "HZ", default_value_t = RATE_CUTOFF_HZ, allow_negative_numbers = true)]
    rate_cutoff: f64,
    /// The same on specific force, where vibration is
    #[arg(long, value_name = "HZ", default_value_t = FORCE_CUTOFF_HZ, allow_negative_numbers = true)]
    force_cutoff: f64,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum FlightPart {
    All,
    Training,
    Validation,
}

const HELP: &str = "Columns of the CSV file: log, time_s, channel, unit, measured, predicted, residual; of a second \
vehicle predicted_2 and residual_2. The residual is what was measured less what was predicted. The MCAP file has a \
topic each channel with the same numbers.

Of a second vehicle it is said by which share its RMS differs from the first one's, with the 95 % interval that \
stretches of two seconds tell: where that holds 0 the two are not told apart.

The open-loop table says how far the simulation is off a moment after it was where the flight was, with nothing but \
the logged commands.

The figures of an identification, to their last digit:
  racer identify flight.mcap --out mine.toml --validated validated.toml
  racer predict flight.mcap --vehicle validated.toml --part validation

Examples:
  racer predict flight.mcap --vehicle mine.toml --out residuals.csv
  racer predict flight.mcap --vehicle mine.toml --vehicle extended.toml --out both.mcap

Exit code 3 means that a log is damaged and that its readable part was used.";

/// Columns of the table of signals; the last of a second vehicle only.
const HEADER: [&str; 8] = ["signal", "vehicle", "RMS", "MAE", "", "R2", "samples", "change of RMS"];

/// What `--json` prints.
#[derive(Serialize)]
struct PredictionDocument<'a> {
    vehicles: &'a [String],
    thrust_driven_by: &'a [&'static str],
    logs: Vec<&'a str>,
    channels: Vec<ChannelDocument>,
    open_loop: &'a [Vec<crate::insight::diagnose::prediction::horizon::Horizon>],
}

/// One channel; scores by vehicle.
#[derive(Serialize)]
struct ChannelDocument {
    name: &'static str,
    unit: &'static str,
    scores: Vec<crate::base::stats::Score>,
    /// By which share the RMS of each vehicle after the first differs from the first one's.
    change: Vec<Option<RmsChange>>,
}

/// Reads, predicts, writes, prints.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let out = args.out.as_deref().map(output).transpose()?;
    let vehicles = vehicles(&args.vehicles)?;
    let options = options(args)?;
    let bar = progress::bar();
    let checked = logs::read(&args.logs, Options { mapping: args.mapping.as_deref(), flight: args.flight }, &bar)?;
    together::flights(&checked)?;
    bar.set_message("predicting");
    let damaged = logs::damaged(&checked);
    let data = Data::new(checked);
    let prediction = predict(&data, &vehicles.iter().collect::<Vec<_>>(), &options);
    bar.finish_and_clear();
    if prediction.channels.is_empty() {
        let expected = "usable flight with commands";
        let advice = "`racer check` names what is missing";
        return Err(BadInput::new("the logs", "nothing that a vehicle predicts", expected, advice).into());
    }
    super::print(&if args.json { json(&prediction)? } else { text(&prediction) })?;
    if let Some((kind, file)) = out {
        let bytes = kind(&prediction)?;
        tell(&format!("signals in {}", file.write(&bytes)?.display()));
    }
    Ok(if damaged { CommandEnd::Damaged } else { CommandEnd::Done })
}

/// The vehicles, by what they were asked for where two have one name: an extended one has its base's.
fn vehicles(asked: &[String]) -> Result<Vec<Vehicle>> {
    let mut all = asked.iter().map(|name| Vehicle::load(name)).collect::<std::result::Result<Vec<_>, _>>()?;
    let names: Vec<String> = all.iter().map(|vehicle| vehicle.name.clone()).collect();
    for (vehicle, asked) in all.iter_mut().zip(asked) {
        if names.iter().filter(|name| **name == vehicle.name).count() > 1 {
            vehicle.name.clone_from(asked);
        }
    }
    Ok(all)
}

fn options(args: &Args) -> std::result::Result<PredictOptions, BadInput> {
    let part = match args.part {
        FlightPart::All => DataPart::All,
        FlightPart::Training => DataPart::Train,
        FlightPart::Validation => DataPart::Validation,
    };
    let (rate_cutoff_hz, force_cutoff_hz) = (args.rate_cutoff, args.force_cutoff);
    let base = Vehicle::load("seed_class")?;
    let checked = IdentifyOptions { rate_cutoff_hz, force_cutoff_hz, ..IdentifyOptions::new(base) };
    checked.check().map_err(|invalid| BadInput::at("command line", invalid))?;
    Ok(PredictOptions { part, rate_cutoff_hz, force_cutoff_hz })
}

/// How a file is encoded.
type Encode = fn(&Prediction) -> Result<Vec<u8>>;

/// The file, and how it is encoded, by the end of its name.
fn output(path: &Path) -> std::result::Result<(Encode, Reserved), BadInput> {
    let end = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let encode: Encode = match end.as_str() {
        "csv" => csv,
        "mcap" => mcap,
        _ => {
            let advice = "the end of the name decides the format";
            return Err(BadInput::new("--out", path.display(), "a name that ends in .csv or .mcap", advice));
        }
    };
    Ok((encode, Reserved::new(path, "--out")?))
}

fn json(prediction: &Prediction) -> Result<String> {
    let channel = |c: &crate::insight::predict::PredictedChannel| ChannelDocument {
        name: c.name,
        unit: c.unit,
        scores: (0..prediction.vehicles.len()).map(|k| c.score(k)).collect(),
        change: (1..prediction.vehicles.len()).map(|k| c.change(k)).collect(),
    };
    let document = PredictionDocument {
        vehicles: &prediction.vehicles,
        thrust_driven_by: &prediction.driven_by,
        logs: prediction.logs.iter().map(|(name, _)| name.as_str()).collect(),
        channels: prediction.channels.iter().map(channel).collect(),
        open_loop: &prediction.ahead,
    };
    encode::json("the prediction", &document)
}

/// A change with its interval.
fn percent(change: RmsChange) -> String {
    let [by, low, high] = [change.by, change.low, change.high].map(|share| 100.0 * share);
    format!("{by:+.1} % ({low:+.1} to {high:+.1})")
}

/// Tables of how well each vehicle predicts.
fn text(prediction: &Prediction) -> String {
    let mut rows = Vec::new();
    for channel in &prediction.channels {
        for (k, vehicle) in prediction.vehicles.iter().enumerate() {
            let score = channel.score(k);
            rows.push(vec![
                if k == 0 { channel.name.to_string() } else { String::new() },
                vehicle.clone(),
                format!("{:.3}", score.rmse),
                format!("{:.3}", score.mae),
                channel.unit.to_string(),
                format!("{:.3}", score.r2),
                score.n.to_string(),
                if k == 0 { String::new() } else { channel.change(k).map_or_else(String::new, percent) },
            ]);
        }
    }
    let columns = HEADER.len() - usize::from(prediction.vehicles.len() == 1);
    rows.iter_mut().for_each(|row| row.truncate(columns));
    let mut out = columns::table(&HEADER[..columns], rows, 2..4);
    let mut rows = Vec::new();
    for (vehicle, ahead) in prediction.vehicles.iter().zip(&prediction.ahead) {
        for h in ahead {
            rows.push(vec![
                vehicle.clone(),
                format!("{:.2}", h.after_s),
                format!("{:.3}", h.velocity_m_s),
                format!("{:.3}", h.position_m),
                format!("{:.2}", h.attitude_deg),
                h.starts.to_string(),
            ]);
        }
    }
    let header = ["open loop", "after, s", "velocity, m/s", "position, m", "attitude, deg", "starts"];
    out += "\n\n";
    out += &if rows.is_empty() {
        "open loop: not without velocity, attitude and commands".to_string()
    } else {
        columns::table(&header, rows, 1..6)
    };
    for (vehicle, source) in prediction.vehicles.iter().zip(&prediction.driven_by) {
        out += &format!("\nthe thrust of {vehicle} is driven by the {source} of the logs");
    }
    out
}
