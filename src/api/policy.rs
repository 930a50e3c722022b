//! A trained policy: read, asked, scored, kept.

use crate::base::error::Result;
use crate::base::lane::Level;
use crate::base::threads;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::present::run::find;
use crate::race::act::act;
use crate::race::env::observe::OBSERVATIONS;
use crate::race::eval::{EvalConfig, Report, both_starts};
use crate::race::snapshot::Snapshot;
use std::path::Path;

/// A policy: a network that flies one track in one vehicle, with what it was trained on.
#[derive(Clone, Debug)]
pub struct Policy(pub(super) Snapshot);

impl Policy {
    /// Reads a snapshot file, or the policy of a run folder: its best, or its last where none was chosen. Fails where
    /// the network does not answer as it did when it was written.
    pub fn load(path: impl AsRef<Path>) -> Result<Self> {
        let found = find(&path.as_ref().display().to_string())?;
        Ok(Self(Snapshot::read(&found.snapshot)?))
    }

    /// Writes a new safetensors file; nothing that exists is overwritten.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        self.0.write(path.as_ref())
    }

    /// The commands to any number of observations: roll, pitch and yaw rate and thrust, each in [-1, 1], to be held for
    /// 10 ms.
    pub fn act(&self, observations: &[[f32; OBSERVATIONS]]) -> Vec<[f32; 4]> {
        act(&self.0.network, observations)
    }

    /// The track that it was trained for.
    pub fn track(&self) -> &Track {
        &self.0.about.track
    }

    /// The vehicle that it was trained for.
    pub fn vehicle(&self) -> &Vehicle {
        &self.0.about.vehicle
    }

    /// Environment steps that it was trained for.
    pub fn steps(&self) -> u64 {
        self.0.about.steps
    }
}

/// Flies the deterministic policy on its track with `agents` vehicles from the pad, and with as many from places along
/// the track, and scores the flights. The first vehicle is `vehicle`, the others have every parameter drawn about it.
/// The result does not depend on the number of threads.
pub fn evaluate(policy: &Policy, vehicle: &Vehicle, agents: usize) -> Result<Report> {
    use crate::base::check::{BadInput, Check};
    let Snapshot { network, about } = &policy.0;
    let config = EvalConfig { agents, ..about.eval.clone() };
    config.check().map_err(|invalid| BadInput::at("an evaluation", invalid))?;
    let race = policy.0.race(Some(vehicle));
    threads::on(None, || both_starts(Level::best(), &race, &about.track, network, &config).0)
}
