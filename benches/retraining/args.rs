//! What to hide and how long to train.

use crate::sizes;
use crate::truth::other::causes;
use clap::Parser;
use std::path::PathBuf;

/// The vehicle as it is, with nothing hidden.
const CLEAN: &str = "clean";

/// Races policies in an independent simulator: trained without an effect, and with what `racer diagnose` made of it
#[derive(Clone, Debug, Parser)]
#[command(name = "retraining")]
pub struct Args {
    /// Identifiers of effects, each with its size or at one at which racing feels it: `rate_delay=0.02`; `all`; `none`;
    /// `clean`, a flight of the vehicle as it is
    #[arg(
        long,
        value_name = "ID[=SIZE]",
        value_delimiter = ',',
        default_value = "rate_delay,voltage_sag,axial_inflow"
    )]
    #[arg(value_parser = parse_case, allow_negative_numbers = true)]
    pub effects: Vec<(String, Option<f64>)>,
    /// Race in the third truth, a quadrotor motor by motor: effects are its causes, each with a size. With `--draw` the
    /// airframe of that number
    #[arg(long)]
    pub by_motor: bool,
    /// Budget of each training, min
    #[arg(long, default_value_t = 2.0)]
    pub minutes: f64,
    /// Budget of each training in environment steps, which no other load on the machine changes
    #[arg(long, conflicts_with = "minutes")]
    pub steps: Option<u64>,
    /// Trainings of each kind
    #[arg(long, default_value_t = 1)]
    pub seeds: u64,
    /// Races of each policy: one nominal, the others with other places and headings at the start and charges
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..))]
    pub agents: u32,
    /// Track to train on and to race [default: the configuration's]
    #[arg(long, value_name = "NAME|FILE")]
    pub track: Option<String>,
    /// In place of the seed class the random vehicle of this number
    #[arg(long, value_name = "NUMBER")]
    pub draw: Option<u64>,
    /// Length of the flight that is diagnosed, s
    #[arg(long, default_value_t = 300.0)]
    pub seconds: f64,
    /// New file: a line of CSV each row
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Keep logs, vehicles, answers and runs in this folder, which is new or empty
    #[arg(long, value_name = "DIR")]
    pub keep: Option<PathBuf>,
    /// Train nothing: race this policy of the seed class in both simulators, without an effect
    #[arg(long, value_name = "RUN", requires = "svg")]
    pub policy: Option<String>,
    /// New file for the picture of the two laps
    #[arg(long, value_name = "FILE", requires = "policy")]
    pub svg: Option<PathBuf>,
    /// The program [default: the one built with this]
    #[arg(long, value_name = "PATH", default_value = env!("CARGO_BIN_EXE_racer"))]
    pub racer: PathBuf,
    /// Passed by `cargo bench`
    #[arg(long, hide = true)]
    pub bench: bool,
}

impl Args {
    /// What this run is, so that it can be made again.
    pub fn summary(&self) -> String {
        let cases: Vec<String> = self.cases().iter().map(|(id, size)| format!("{id}={size}")).collect();
        let cases = if cases.is_empty() { "none".into() } else { cases.join(",") };
        let budget = self.budget().join(" ");
        let track = self.track.as_ref().map_or(String::new(), |track| format!(" --track {track}"));
        let draw = self.draw.map_or(String::new(), |number| format!(" --draw {number}"));
        let (seeds, agents, seconds) = (self.seeds, self.agents, self.seconds);
        let by_motor = if self.by_motor { " --by-motor" } else { "" };
        format!(
            "--effects {cases}{by_motor} {budget} --seeds {seeds} --agents {agents} --seconds {seconds}{track}{draw}"
        )
    }

    /// Identifiers and sizes.
    pub fn cases(&self) -> Vec<(String, f64)> {
        let given = self.effects.iter().flat_map(|(id, size)| match id.as_str() {
            "none" => Vec::new(),
            "all" => sizes::SIZES.iter().map(|(id, size)| (id.to_string(), *size)).collect(),
            CLEAN => vec![(id.clone(), 0.0)],
            _ => vec![(id.clone(), size.or_else(|| sizes::of(id)).expect("the parser asks for a size"))],
        });
        given.collect()
    }

    /// As `racer train` takes it.
    pub fn budget(&self) -> [String; 2] {
        match self.steps {
            Some(steps) => ["--steps".into(), steps.to_string()],
            None => ["--minutes".into(), self.minutes.to_string()],
        }
    }
}

fn parse_case(text: &str) -> Result<(String, Option<f64>), String> {
    let (id, size) = match text.split_once('=') {
        Some((id, size)) => (id, Some(size.parse().map_err(|_| format!("`{size}` is no size"))?)),
        None => (text, None),
    };
    let by_motor = causes::KINDS.iter().any(|kind| kind.id == id);
    if by_motor && size.is_some() {
        return Ok((id.into(), size));
    }
    if matches!(id, "none" | "all" | CLEAN) || size.or_else(|| sizes::of(id)).is_some() && sizes::known(id) {
        return Ok((id.into(), size));
    }
    Err(if sizes::known(id) || by_motor {
        format!("{id} needs a size: {id}=SIZE")
    } else {
        format!("no effect `{id}`")
    })
}
