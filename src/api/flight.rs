//! Flight logs: recorded in the simulator, read, kept.

use super::policy::Policy;
use crate::base::check::BadInput;
use crate::base::error::{Error, Result};
use crate::base::fsio::write_new;
use crate::base::lane::Level;
use crate::flight::fly::{by_pilot, by_policy, check_pilot};
use crate::flight::sensors::SensorConfig;
use crate::flight::{Log, open, write};
use crate::model::vehicle::Vehicle;
use std::path::Path;

impl Log {
    /// Reads a log: MCAP, Betaflight blackbox, PX4 ULog or CSV. What its fields mean is the format's own, or a built-in
    /// mapping that fits. Nothing is repaired; [`crate::check`] does that. Of a damaged file the readable part is read,
    /// and [`Log::readable`] says so.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        Ok(open(path.as_ref(), None)?)
    }

    /// [`Log::open`] with the mapping of this name or file, which says what the fields mean.
    pub fn open_as(path: impl AsRef<Path>, mapping: &str) -> Result<Self> {
        Ok(open(path.as_ref(), Some(mapping))?)
    }

    /// Writes a new MCAP file with ROS 2 messages; nothing that exists is overwritten.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        write_new(path.as_ref(), &write::mcap(self)?).map_err(Error::write(path.as_ref()))
    }
}

/// The excitation pilot flies `vehicle` in the simulator through all that identification needs, from the ground until
/// it has landed, for at most `seconds`, and `sensors` record it. It lands early where the battery is empty before.
/// `seed` decides the order of the manoeuvres and the errors of the sensors. Fails for less than 40 s, which take-off
/// and landing need.
pub fn fly_pilot(vehicle: &Vehicle, sensors: &SensorConfig, seconds: f64, seed: u64) -> Result<Log, BadInput> {
    check_pilot("a pilot's flight", seconds)?;
    Ok(by_pilot(vehicle, sensors, &[], seed, seconds).log)
}

/// `policy` races from the pad of its track in `vehicle`, lap after lap, until it fails or for `seconds`, and `sensors`
/// record it.
pub fn fly_policy(policy: &Policy, vehicle: &Vehicle, sensors: &SensorConfig, seconds: f64, seed: u64) -> Log {
    let race = policy.0.race(Some(vehicle)).scored(policy.track());
    by_policy(Level::best(), &race, &policy.0.network, sensors, seed, seconds).log
}
