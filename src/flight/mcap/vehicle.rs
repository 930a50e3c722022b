//! The metadata record `racer.vehicle`.

use super::bytes::Bytes;
use crate::base::check::BadInput;
use crate::flight::{MOTORS, VehicleKind, VehicleRecord};
use std::collections::BTreeMap;

/// Name of the record.
pub const NAME: &str = "racer.vehicle";
/// Its keys.
pub const MASS: &str = "mass_kg";
pub const MAX_RATE: &str = "max_rate_rad_s";
pub const KIND: &str = "kind";
pub const ROTORS: &str = "rotors";
pub const THRUST_MAP: &str = "thrust_map";
/// The only thrust map there is: how the setpoint's thrust becomes a policy's command.
pub const THRUST: &str = "0..1 -> -1..1";

/// Bytes that the record may take.
const BYTES: usize = 1 << 16;

/// The record with these keys and values.
pub fn read(values: &[u8]) -> Result<VehicleRecord, BadInput> {
    let wrong = |key: &str, found: &str, expected: &str| {
        let advice = "write the metadata record again, or leave it out and name a vehicle file";
        BadInput::new(format!("metadata record {NAME}, {key}"), format!("{found:?}"), expected, advice)
    };
    let values = map(values).ok_or_else(|| wrong("values", "damaged bytes", "keys and values"))?;
    let numbers = |key: &str, n: usize, expected: &str| {
        let Some(&text) = values.get(key) else { return Ok(None) };
        let parts = text.split(|c: char| c.is_whitespace() || "[](),".contains(c)).filter(|part| !part.is_empty());
        let positive = |part: &str| part.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
        match parts.map(positive).collect::<Option<Vec<_>>>() {
            Some(numbers) if numbers.len() == n => Ok(Some(numbers)),
            _ => Err(wrong(key, text, expected)),
        }
    };
    if let Some(&found) = values.get(THRUST_MAP)
        && found.trim() != THRUST
    {
        return Err(wrong(THRUST_MAP, found, THRUST));
    }
    let kind = values.get(KIND).map(|name| {
        VehicleKind::of(name)
            .ok_or_else(|| wrong(KIND, name, "multirotor, fixed_wing, vtol, helicopter, rover or other"))
    });
    let rotors = values.get(ROTORS).map(|text| {
        let rotors = text.parse().ok().filter(|rotors: &u8| (1..=MOTORS).contains(&usize::from(*rotors)));
        rotors.ok_or_else(|| wrong(ROTORS, text, &format!("1 to {MOTORS}")))
    });
    Ok(VehicleRecord {
        mass_kg: numbers(MASS, 1, "a number above 0")?.map(|mass| mass[0]),
        max_rate_rad_s: numbers(MAX_RATE, 3, "three numbers above 0")?.map(|rate| [rate[0], rate[1], rate[2]]),
        kind: kind.transpose()?,
        rotors: rotors.transpose()?,
    })
}

fn map(values: &[u8]) -> Option<BTreeMap<&str, &str>> {
    if values.len() > BYTES {
        return None;
    }
    let mut rest = Bytes(values);
    let mut map = BTreeMap::new();
    while !rest.0.is_empty() {
        map.insert(rest.text()?, rest.text()?);
    }
    Some(map)
}
