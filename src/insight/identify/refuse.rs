//! What is refused: logs that would give a wrong vehicle, and results that are none.

use super::IdentifyOptions;
use super::result::Identification;
use crate::base::check::{BadInput, Check};
use crate::base::error::{Error, Result};
use crate::insight::quality::{Quality, together};

/// Fails where a log contradicts itself, such as a rate that goes against its setpoint.
pub fn problems(logs: &[Quality]) -> Result<(), BadInput> {
    for quality in logs {
        if let Some(finding) = quality.problem() {
            let expected = "a log without problems";
            // Nothing is left to go on with.
            let advice = if quality.usable.is_empty() {
                "give another log, with more of the flight: `racer check` says what of this one is left out, and why"
                    .into()
            } else {
                format!("mend the log or its mapping, or go on with --despite-problems. As it is: {}", finding.so)
            };
            return Err(BadInput::new(&quality.log.name, &finding.what, expected, advice));
        }
    }
    Ok(())
}

/// Fails where the logs' records are of different vehicles. What the options say, the records need not.
pub fn mixed(logs: &[Quality], options: &IdentifyOptions) -> Result<(), BadInput> {
    together::kinds(logs)?;
    if options.mass_kg.is_none() {
        together::masses(logs)?;
    }
    if options.max_rate_rad_s.is_none() {
        together::full_rates(logs)?;
    }
    Ok(())
}

/// Fails where no parameter could be told; unless `partial`, where rates or thrust could not be told at all; and where
/// the vehicle could not fly.
pub fn nothing(found: &Identification, partial: bool) -> Result<()> {
    if found.channels.is_empty() {
        let why = "no parameter could be told";
        let advice = "`racer check` names what is missing";
        return Err(BadInput::new("the logs", why, "at least one response", advice).into());
    }
    let kept = &found.kept;
    let rates = kept.lag[..3].contains(&true) || kept.rate.contains(&true);
    for (told, what, key) in [(rates, "rates", "time_constant_s.roll"), (kept.thrust, "thrust", "thrust_n")] {
        if !told && !partial {
            let why = found.lent(key).map_or("the log does not tell it", String::as_str);
            let why = format!("no {what}: {why}");
            let advice = "a vehicle with the base vehicle's in their place is written with --partial";
            return Err(BadInput::new("the logs", why, "rates and thrust that the logs tell", advice).into());
        }
    }
    let cannot = |key, found| Error::Failed(format!("the identified vehicle cannot fly: {key}: {found}"));
    found.vehicle.check().map_err(|invalid| cannot(invalid.key, invalid.found))
}
