//! An effect that flights show: how sure, how large, and what it explains.

use crate::base::stats::NORMAL_95;
use crate::insight::criteria::shown::MENTIONED_SHARE;
use crate::insight::diagnose::selection::caused::ForceCause;
use crate::model::effects::{self, Card, Role};
use serde::Serialize;
use std::collections::BTreeMap;

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
    /// How it acts on the base vehicle, where it is the cause of all that thrust and drag have moved by.
    #[serde(skip)]
    pub cause: Option<ForceCause>,
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
    /// Why it is no more than suspected, or, of what is named, why the extended vehicle goes without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
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
            cause: None,
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

    /// Whether the extended vehicle may have a part of it: it is named, and nothing speaks against that.
    pub fn in_vehicle(&self) -> bool {
        self.status != Status::Suspected && self.why.is_none()
    }

    /// Why the extended vehicle goes without what is named.
    pub fn unwritten(&self) -> Option<String> {
        let named = self.status != Status::Suspected;
        self.why.as_ref().filter(|_| named).map(|why| format!("not in the extended vehicle: {why}"))
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
