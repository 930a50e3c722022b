//! `racer export`: a policy for other programs.

use super::{CommandEnd, tell};
use crate::base::check::BadInput;
use crate::base::fsio;
use crate::present::export::{ExportFormat, Exported};
use crate::present::run::{self, FoundPolicy};
use crate::race::snapshot::Snapshot;
use clap::ValueEnum;
use std::path::{Path, PathBuf};

/// Write a policy as C sources, as an ONNX model, or as one JSON document
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// A run folder (its best policy), a snapshot file, or `latest` for the youngest run below runs/
    #[arg(value_name = "RUN|SNAPSHOT|latest")]
    policy: String,
    /// What to write
    #[arg(long, value_enum)]
    format: FormatName,
    /// New folder for the files [default: `export-FORMAT` in the run folder, or beside the snapshot]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const HELP: &str =
    "Every export holds the SHA-256 of the policy's file, frames and units, the gates, and a self-test: \
steps of a lap across switches of the target gate, with states, observations, actions and setpoints. What does not \
pass it does not fly. docs/flying.md leads from here to a vehicle. No licence comes with an export.

C: racer_step(&pilot, &state, &setpoint) in C99, 33 kB, without allocation or library. ONNX: the network alone; \
observation and setpoint are yours to make, as its metadata says. JSON: metadata, weights and self-test.

Examples:
  racer export latest --format c
  racer export runs/mine --format onnx --out model";

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FormatName {
    /// C99 sources without allocation or library, with examples
    C,
    /// An ONNX model of the network, with everything else in its metadata
    Onnx,
    /// Everything in one document
    Json,
}

impl FormatName {
    /// The format, and a name for its folder.
    fn format(self) -> (ExportFormat, &'static str) {
        match self {
            FormatName::C => (ExportFormat::C, "export-c"),
            FormatName::Onnx => (ExportFormat::Onnx, "export-onnx"),
            FormatName::Json => (ExportFormat::Json, "export-json"),
        }
    }
}

/// Reads, exports, writes.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let found = run::find(&args.policy)?;
    let snapshot = Snapshot::read(&found.snapshot)?;
    let bytes = std::fs::read(&found.snapshot).map_err(|error| {
        BadInput::new(found.snapshot.display(), error, "a policy snapshot (.safetensors) of `racer train`", "")
    })?;
    let exported = Exported::new(snapshot, &bytes)?;
    let (format, name) = args.format.format();
    let files = exported.files(format)?;
    let folder = args.out.clone().unwrap_or_else(|| default_folder(&found, name));
    fsio::new_folder(&folder, "--out")?;
    for (name, bytes) in &files {
        let path = folder.join(name);
        if let Some(inner) = path.parent() {
            std::fs::create_dir_all(inner)?;
        }
        fsio::write_new(&path, bytes)?;
    }
    super::print(&summary(&exported))?;
    remarks(&exported).iter().for_each(|remark| tell(remark));
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    tell(&format!("{} in {}", names.join(", "), folder.display()));
    Ok(CommandEnd::Done)
}

fn default_folder(found: &FoundPolicy, name: &str) -> PathBuf {
    let name = match &found.run {
        Some(_) => name.into(),
        None => format!("{}-{name}", found.snapshot.file_stem().unwrap_or_default().to_string_lossy()),
    };
    run::free(&found.run.as_deref().or(found.snapshot.parent()).unwrap_or(Path::new("")).join(name))
}

fn summary(exported: &Exported) -> String {
    let about = &exported.snapshot.about;
    let test = &exported.metadata["flying"]["self_test"];
    let lap = test["lap_s"].as_f64();
    let lap = lap.map_or("none in its time".into(), |lap| format!("{lap:.3} s, by the exported rules"));
    format!(
        "policy     sha256 {}\nraces      {} in {}\nlap        {lap}\nself-test  {} steps, {} switches of the gate",
        exported.sha256, about.track.name, about.vehicle.name, test["steps"], test["switches"]
    )
}

/// What the user has to know about this export.
fn remarks(exported: &Exported) -> Vec<String> {
    let flying = &exported.metadata["flying"];
    let mut out = Vec::new();
    if flying["self_test"]["lap_s"].is_null() {
        out.push("the policy flies no lap in the simulator: train it further before a vehicle flies it".into());
    }
    if flying["self_test"]["switches"].as_u64().unwrap_or(0) < 2 {
        out.push("the self-test holds fewer than two switches of the target gate: it does not prove them".into());
    }
    if flying["model"]["complete"] == false {
        out.push(
            "the vehicle has effects beyond the compact model: the exported filter of the command is first order, and \
             the lap above is flown with it"
                .into(),
        );
    }
    out
}
