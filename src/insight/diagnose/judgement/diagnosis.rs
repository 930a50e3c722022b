//! All that a diagnosis says.

use super::finding::{Finding, Gain, Status};
use crate::insight::diagnose::prediction::horizon::Horizon;
use crate::insight::diagnose::selection::accident::LeftOut;
use crate::insight::diagnose::structure::Structure;
use serde::Serialize;
use std::collections::BTreeMap;

/// The answer in a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No effect beyond noise.
    Clean,
    /// Effects, and nothing that they leave.
    Effects,
    /// Structure remains that no effect explains.
    Unexplained,
}

/// A number of the compact model that differs from the base vehicle's.
#[derive(Clone, Debug, Serialize)]
pub struct Drift {
    /// Which number.
    pub parameter: String,
    /// What the base vehicle says.
    pub base: f64,
    /// What the flights say.
    pub value: f64,
    /// Lower end of its 95 % interval.
    pub low: f64,
    /// Upper end of its 95 % interval.
    pub high: f64,
    /// What the extended vehicle has, where there is one: the base's, where a move does not pay on unseen flight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub in_vehicle: Option<f64>,
    /// Of all five.
    pub unit: &'static str,
}

/// An effect that these flights could not show, or not at a size that matters.
#[derive(Clone, Debug, Serialize)]
pub struct NotDetectable {
    /// Identifier.
    pub effect: &'static str,
    /// Why it could not show.
    pub why: String,
    /// The smallest size that they would show, and its unit.
    pub smallest: Option<f64>,
    /// Of the size.
    pub unit: &'static str,
}

/// What the flights could show of an effect.
#[derive(Clone, Debug, Serialize)]
pub struct Detectable {
    /// Identifier.
    pub effect: &'static str,
    /// The size of its main parameter from which nine of ten such flights show it.
    pub smallest: f64,
    /// The smallest size that they tell from the nearest rival.
    pub told_apart: f64,
    /// That rival.
    pub nearest: Option<&'static str>,
    /// Of the sizes.
    pub unit: &'static str,
    /// From where to where it usually lies.
    pub typical: [f64; 2],
    /// What shows it best.
    pub manoeuvre: &'static str,
}

/// Open-loop errors before and after.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Ahead {
    /// With the base vehicle.
    pub before: Horizon,
    /// With the extended one.
    pub after: Horizon,
}

/// A channel before and after.
#[derive(Clone, Debug, Serialize)]
pub struct Residual {
    /// RMS with the base vehicle.
    pub before: f64,
    /// RMS with the extended one.
    pub after: f64,
    /// Standard deviation of what is unpredictable in it.
    pub noise: f64,
    /// Of all three.
    pub unit: &'static str,
    /// Share of the variance that the base vehicle explains.
    pub r2_before: f64,
    /// The same with the extended one.
    pub r2_after: f64,
}

/// Everything that a diagnosis found.
#[derive(Clone, Debug, Serialize)]
pub struct Diagnosis {
    /// The answer in a word.
    pub verdict: Verdict,
    /// Names of the logs.
    pub logs: Vec<String>,
    /// Name of the base vehicle.
    pub base: String,
    /// Usable flight, s.
    pub usable_s: f64,
    /// Seconds that were left out because something happened in them.
    pub left_out: Vec<LeftOut>,
    /// By impact.
    pub findings: Vec<Finding>,
    /// Evident, and too small for anybody to notice.
    pub small: Vec<Finding>,
    /// What no effect explains.
    pub unexplained: Vec<Structure>,
    /// Effects that these flights could not show.
    pub not_detectable: Vec<NotDetectable>,
    /// Effects that they could.
    pub detectable: Vec<Detectable>,
    /// Numbers of the compact model that have moved.
    pub drift: Vec<Drift>,
    /// One step ahead, on the flight that was fitted.
    pub residuals: BTreeMap<&'static str, Residual>,
    /// On flight that was not used for fitting.
    pub held_out: BTreeMap<&'static str, Gain>,
    /// Open-loop errors, by how far ahead.
    pub horizons: Vec<Ahead>,
    /// Share of what could be gained at most that was gained, on flight that was not used for fitting.
    pub captured: Option<f64>,
    /// Why there is no extended vehicle, where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_extended: Option<String>,
    /// Structure before and after, by channel.
    pub structure_before: Vec<Structure>,
    /// The same after.
    pub structure: Vec<Structure>,
}

impl Diagnosis {
    /// The verdict in a sentence.
    pub fn headline(&self) -> String {
        let seconds = self.usable_s;
        let count = |n: usize| if n == 1 { "one effect".to_string() } else { format!("{n} effects") };
        let suspected = self.findings.iter().filter(|f| f.status == Status::Suspected).count();
        let found = match (self.findings.len() - suspected, suspected) {
            (0, suspected) => format!("{} suspected, none named,", count(suspected)),
            (named, 0) => count(named),
            (named, suspected) => format!("{} and {suspected} suspected", count(named)),
        };
        match self.verdict {
            Verdict::Clean => format!("no effect beyond noise in {seconds:.0} s of flight"),
            Verdict::Effects => format!("{found} in {seconds:.0} s of flight; nothing structured is left"),
            Verdict::Unexplained => {
                let what =
                    if self.findings.is_empty() { "structure".into() } else { format!("{found}, and structure") };
                format!("{what} that no effect of the catalogue explains, in {seconds:.0} s of flight")
            }
        }
    }
}
