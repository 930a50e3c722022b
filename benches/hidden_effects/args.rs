//! What to draw and what to run.

use crate::truth::hidden::Style;
use clap::{Parser, ValueEnum};
use std::path::PathBuf;

/// Which truths are hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Tier {
    /// The catalogue's own equations: none 30 %, one 50 %, two 15 %, and 5 % outside
    Matched,
    /// Causes of the catalogue in other forms
    Unmatched,
    /// Ten effects that do not matter and one that does
    Clutter,
    /// Causes that the catalogue does not have
    Outside,
    /// The catalogue's causes in a vehicle, and in forms, of other making
    Other,
    /// Effects put into measured flights
    Real,
    /// Half matched, the rest of the other kinds, then the measured flights
    All,
}

/// How the logs are flown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Flying {
    Excited,
    Race,
    /// Every third log a race
    Mixed,
}

/// Scores `racer diagnose` on flights whose truth is known
#[derive(Debug, Parser)]
#[command(name = "hidden_effects")]
pub struct Args {
    /// Number of logs
    #[arg(long, default_value_t = 300)]
    pub n: usize,
    /// Number of the first one: a long run can be made in parts
    #[arg(long, default_value_t = 0)]
    pub from: usize,
    /// Instead of single logs: pairs of flights of one vehicle of the third truth, half without a change between them
    #[arg(long)]
    pub against: bool,
    /// With `--against`: only what the motors tell, without the program; hundreds of pairs a minute
    #[arg(long, requires = "against")]
    pub by_motors: bool,
    /// Instead of single logs: flights of few manoeuvres, the plans that the program makes of those with tied causes,
    /// and what both flights show
    #[arg(long, conflicts_with = "against")]
    pub plan: bool,
    /// Decides everything that is drawn
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    #[arg(long, value_enum, default_value_t = Tier::Matched)]
    pub tier: Tier,
    #[arg(long, value_enum, default_value_t = Flying::Excited)]
    pub style: Flying,
    /// Length of a flight, s
    #[arg(long, default_value_t = 300.0)]
    pub seconds: f64,
    /// Hide this one in every log: an identifier, a kind of another tier, `none` or `drift`
    #[arg(long, value_name = "ID")]
    pub only: Option<String>,
    /// With `--only` an identifier: its size, in the catalogue's unit, of either sign
    #[arg(long, requires = "only", allow_negative_numbers = true)]
    pub size: Option<f64>,
    /// Logs at a time
    #[arg(long, default_value_t = 1)]
    pub jobs: usize,
    /// Keep logs, answers and truths in this folder
    #[arg(long, value_name = "DIR")]
    pub keep: Option<PathBuf>,
    /// Instead of a score: halve and double these criteria, or all, and say what changes
    #[arg(long, value_name = "NAME", num_args = 0..)]
    pub criteria: Option<Vec<String>>,
    /// With `--criteria`: logs that an earlier run kept; without, `--n` are drawn
    #[arg(long, value_name = "DIR", requires = "criteria")]
    pub logs: Option<PathBuf>,
    /// Ask for the extended vehicle as well, train it for a moment, and hold it against a flight that nothing has seen
    #[arg(long)]
    pub extended: bool,
    /// Every log in a line of CSV, as each is done; what the file has of this build and these flights is not done
    /// again. With `--criteria`, the table
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// What the rows call the program [default: the commit here]
    #[arg(long, value_name = "NAME")]
    pub build: Option<String>,
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
        let only = self.only.as_ref().map_or(String::new(), |only| format!(" --only {only}"));
        let only = self.size.map_or(only.clone(), |size| format!("{only} --size {size}"));
        let [tier, style] = [format!("{:?}", self.tier), format!("{:?}", self.style)].map(|name| name.to_lowercase());
        let (n, seed, seconds) = (self.n, self.seed, self.seconds);
        let from = if self.from > 0 { format!(" --from {}", self.from) } else { String::new() };
        if self.plan {
            return format!("--plan --n {n} --seed {seed}{from}{only}");
        }
        let by = if self.by_motors { " --by-motors" } else { "" };
        let only = if self.against { format!("{from} --against{by}{only}") } else { from + &only };
        format!("--n {n} --seed {seed} --tier {tier} --style {style} --seconds {seconds}{only}")
    }

    pub fn style_of(&self, number: usize) -> Style {
        match self.style {
            Flying::Excited => Style::Excited,
            Flying::Race => Style::Race,
            Flying::Mixed if number % 3 == 2 => Style::Race,
            Flying::Mixed => Style::Excited,
        }
    }
}
