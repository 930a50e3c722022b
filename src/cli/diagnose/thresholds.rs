//! The thresholds of a diagnosis: listed for everybody, and scaled for who measures them, which is not in the help.

use crate::base::check::BadInput;
use crate::insight::criteria::{self, Source};

/// Options about them.
#[derive(Debug, clap::Args)]
pub struct Thresholds {
    /// Only list every threshold of checks and diagnoses as CSV: name, value, question, where it comes from, what it
    /// decides
    #[arg(long)]
    pub criteria: bool,
    /// Scale a criterion for this diagnosis
    #[arg(long, hide = true, value_name = "NAME=FACTOR")]
    scale_criterion: Vec<String>,
}

impl Thresholds {
    /// Scales what was asked for.
    pub fn scale(&self) -> Result<(), BadInput> {
        criteria::scale(&self.scale_criterion)
    }
}

/// Every criterion in a line.
pub fn list() -> anyhow::Result<String> {
    let mut out = csv::Writer::from_writer(Vec::new());
    out.write_record(["name", "value", "question", "source", "reason", "what"])?;
    for criterion in criteria::all() {
        let (source, reason) = match criterion.source {
            Source::Theory(reason) => ("theory", reason),
            Source::Assumed(reason) => ("assumed", reason),
        };
        let value = criterion.value.to_string();
        out.write_record([criterion.name, &value, criterion.question, source, reason, criterion.what.trim()])?;
    }
    Ok(String::from_utf8(out.into_inner()?)?)
}
