//! From checked logs to vehicles, and to what the vehicles get wrong.

use crate::base::check::{BadInput, Check};
use crate::base::error::Result;
use crate::insight::diagnose::{self as diagnosing, Diagnosed};
use crate::insight::identify::result::Identification;
use crate::insight::identify::{self as identifying, IdentifyOptions, refuse};
use crate::insight::predict::{self as predicting, PredictOptions, Prediction};
use crate::insight::prepare::data::{Data, DataPart};
use crate::insight::quality::{Quality, together};
use crate::model::vehicle::Vehicle;

/// Identifies one vehicle from its checked logs, in the order of flight. `watch` is told each step and the share that
/// is done, 0 to 1. Fails on a log that contradicts itself, such as a rate that goes against its setpoint, on a flight
/// that is given twice, on logs whose records are of different vehicles, and where rates or thrust could not be told,
/// unless the options say that a part is enough.
pub fn identify(
    logs: &[Quality],
    options: &IdentifyOptions,
    mut watch: impl FnMut(&str, f64),
) -> Result<Identification> {
    options.check().map_err(|invalid| BadInput::at("options of identification", invalid))?;
    together::flights(logs)?;
    refuse::problems(logs)?;
    refuse::mixed(logs, options)?;
    let found = identifying::identify(logs.to_vec(), options, &mut watch);
    refuse::nothing(&found, options.partial)?;
    Ok(found)
}

/// Names what the simulation of `vehicle` gets wrong in these checked logs, with the vehicle extended by it. `watch` is
/// told each step and the share that is done, 0 to 1.
pub fn diagnose(logs: &[Quality], vehicle: &Vehicle, mut watch: impl FnMut(&str, f64)) -> Diagnosed {
    diagnosing::diagnose(logs.to_vec(), vehicle, &mut watch)
}

/// Holds finished vehicles, compact or extended, against these checked logs without fitting anything: measured and
/// predicted signals of the usable flight at the same samples, and how far off each simulation is a moment after it was
/// where the flight was.
pub fn predict(logs: &[Quality], vehicles: &[&Vehicle], part: DataPart) -> Prediction {
    let (rate_cutoff_hz, force_cutoff_hz) = (identifying::RATE_CUTOFF_HZ, identifying::FORCE_CUTOFF_HZ);
    let options = PredictOptions { part, rate_cutoff_hz, force_cutoff_hz };
    predicting::predict(&Data::new(logs.to_vec()), vehicles, &options)
}
