//! What a diagnosis says.

use super::accident::LeftOut;
use super::horizon::Horizon;
use super::structure::Structure;
use crate::base::stats::NORMAL_95;
use crate::insight::criteria::shown::MENTIONED_SHARE;
use crate::model::effects::{self, Card, Role};
use serde::Serialize;
use std::collections::BTreeMap;

/// The whole answer.
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

/// How sure a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Evident, replicated, of a size that matters, and told from all others.
    Named,
    /// One of several, which these flights do not tell apart.
    NamedSet,
    /// Too few stretches of flight agree, or it does not explain enough.
    Suspected,
}

/// A number with its 95 % interval.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Value {
    /// The best estimate.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// Of all three.
    pub unit: String,
}

impl Value {
    /// Of an estimate and its standard deviation.
    pub fn measured(value: f64, sd: f64, unit: &str) -> Self {
        let half = NORMAL_95 * sd;
        Self { value, low: value - half, high: value + half, unit: unit.into() }
    }
}

/// Before and after, in `unit`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gain {
    /// RMSE without.
    pub before: f64,
    /// RMSE with.
    pub after: f64,
    /// Shares of the variance that the model explains.
    pub r2_before: f64,
    /// The same with.
    pub r2_after: f64,
    /// Of the RMSE.
    pub unit: &'static str,
}

/// An effect that the flights show.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// Identifier.
    pub effect: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// How sure it is.
    pub status: Status,
    /// All that it may be, itself first; only itself where it is named.
    pub members: Vec<&'static str>,
    /// Effects of its family that the vehicle has beside it: they come nearer to its form, and have no name of their
    /// own. Their sizes stand among its parameters.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub with: Vec<&'static str>,
    /// What it means, in a sentence.
    pub sentence: &'static str,
    /// The channel that it explains most of.
    pub channel: &'static str,
    /// Its size, by parameter.
    pub parameters: BTreeMap<String, Value>,
    /// Stretches of flight that agree.
    pub stretches: f64,
    /// Share of each channel's residual power that goes with it.
    pub explained: BTreeMap<&'static str, f64>,
    /// On flight that was not used for fitting: the extended model without this effect, and with it.
    pub gain: BTreeMap<&'static str, Gain>,
    /// How far apart the simulations with and without it are after one second, m/s; for sensors, what the error
    /// integrates to.
    pub impact: f64,
    /// Identifiers of effects that look like it.
    pub rivals: Vec<&'static str>,
    /// What to fly to be surer.
    pub manoeuvre: &'static str,
    /// Names of the manoeuvres of the pilot that show it.
    pub kinds: Vec<&'static str>,
    /// Why it is no more than suspected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
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
    /// Of all four.
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
    /// The smallest size that they show, and that they tell from the nearest rival.
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
        let found = match self.findings.len() {
            1 => "one effect".into(),
            n => format!("{n} effects"),
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

impl Finding {
    /// Named, of an effect that nothing more is known of yet.
    pub fn of(card: &'static Card) -> Self {
        let (manoeuvre, kinds) = card.manoeuvre;
        Finding {
            effect: card.id,
            name: card.name,
            status: Status::Named,
            members: vec![card.id],
            with: Vec::new(),
            sentence: card.sentence,
            channel: "",
            parameters: BTreeMap::new(),
            stretches: 0.0,
            explained: BTreeMap::new(),
            gain: BTreeMap::new(),
            impact: 0.0,
            rivals: effects::rivals(card),
            manoeuvre,
            kinds: kinds.to_vec(),
            why: None,
        }
    }

    /// Whether its effect acts on a log in this way.
    pub fn has(&self, role: Role) -> bool {
        effects::card(self.effect).is_some_and(|card| card.role == role)
    }

    /// It is no more than suspected.
    pub fn suspect(&mut self, why: String) {
        (self.status, self.why) = (Status::Suspected, Some(why));
    }

    /// It may as well be the effect `id`.
    pub fn or(&mut self, id: &'static str) {
        if !self.members.contains(&id) {
            self.members.push(id);
        }
        if self.status == Status::Named {
            self.status = Status::NamedSet;
        }
    }

    /// It may as well be the effect of `other`, which comes nearer to its form beside it.
    pub fn with(&mut self, other: Finding) {
        self.or(other.effect);
        self.with.push(other.effect);
        self.with.extend(other.with);
    }

    /// The effects that the vehicle has where it is named, with what their parameters are called in front.
    pub fn cards(&self) -> impl Iterator<Item = (&'static Card, String)> {
        let own = std::iter::once((self.effect, String::new()));
        let all = own.chain(self.with.iter().map(|id| (*id, format!("{id}."))));
        all.filter_map(|(id, prefix)| Some((effects::card(id)?, prefix)))
    }

    /// Shares of the channels that are worth a word, the largest first.
    pub fn mentioned(&self) -> Vec<(&'static str, f64)> {
        let mut shares: Vec<_> =
            self.explained.iter().map(|(c, s)| (*c, *s)).filter(|(_, s)| *s >= MENTIONED_SHARE.get()).collect();
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        shares
    }
}
