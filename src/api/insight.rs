//! From checked logs to vehicles, and to what the vehicles get wrong.

use crate::base::check::{BadInput, Check};
use crate::base::error::Result;
use crate::insight::diagnose::{self as diagnosing, Diagnosed};
use crate::insight::identify::result::Identification;
use crate::insight::identify::{self as identifying, IdentifyOptions, refuse};
use crate::insight::quality::Quality;
use crate::model::vehicle::Vehicle;

/// Identifies one vehicle from its checked logs, in the order of flight. `watch` is told each step and the share that
/// is done, 0 to 1. Fails on a log that contradicts itself, such as a rate that goes against its setpoint, and where no
/// parameter could be told.
pub fn identify(
    logs: &[Quality],
    options: &IdentifyOptions,
    mut watch: impl FnMut(&str, f64),
) -> Result<Identification> {
    options.check().map_err(|invalid| BadInput::at("options of identification", invalid))?;
    refuse::problems(logs)?;
    let found = identifying::identify(logs.to_vec(), options, &mut watch);
    refuse::nothing(&found)?;
    Ok(found)
}

/// Names what the simulation of `vehicle` gets wrong in these checked logs, with the vehicle extended by it. `watch` is
/// told each step and the share that is done, 0 to 1.
pub fn diagnose(logs: &[Quality], vehicle: &Vehicle, mut watch: impl FnMut(&str, f64)) -> Diagnosed {
    diagnosing::diagnose(logs.to_vec(), vehicle, &mut watch)
}
