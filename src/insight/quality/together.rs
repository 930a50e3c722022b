//! Whether logs can be taken together: no flight twice, and flights of one vehicle.

use super::Quality;
use crate::base::check::BadInput;
use crate::flight::{Stream, VehicleRecord};
use crate::insight::criteria::consistent::SAME_RECORD;

const ONE_VEHICLE: &str = "flights of one vehicle";

/// Every pair of logs, the earlier first.
fn pairs(logs: &[Quality]) -> impl Iterator<Item = (&Quality, &Quality)> {
    logs.iter().enumerate().flat_map(|(i, later)| logs[..i].iter().map(move |earlier| (earlier, later)))
}

/// Fails where two of the logs are one flight: it would count twice, and intervals would be too narrow.
pub fn flights(logs: &[Quality]) -> Result<(), BadInput> {
    let Some((earlier, later)) = pairs(logs).find(|(a, b)| same(&a.log.imu, &b.log.imu)) else { return Ok(()) };
    let found = format!("the same flight as {}", earlier.log.name);
    let advice = "give each flight once";
    Err(BadInput::new(&later.log.name, found, "another flight", advice))
}

/// Whether two streams have the same numbers, and lack the same.
fn same<const N: usize>(a: &Stream<N>, b: &Stream<N>) -> bool {
    let bits = |rows: &[[f64; N]]| rows.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    !a.is_empty() && a.time_s == b.time_s && bits(&a.rows) == bits(&b.rows)
}

/// Fails where the logs' records name vehicles of different kinds or with different rotors.
pub fn kinds(logs: &[Quality]) -> Result<(), BadInput> {
    let of = |quality: &Quality| (quality.log.vehicle.kind, quality.log.vehicle.rotors);
    let Some((earlier, later)) = pairs(logs).find(|(a, b)| of(a) != of(b)) else { return Ok(()) };
    let found = format!("the log of {}, and {} of {}", kind(later), earlier.log.name, kind(earlier));
    let advice = "leave out the flights of another vehicle. Where it is the same, say so in [vehicle] of a --mapping, \
                  or give --despite-problems";
    Err(BadInput::new(&later.log.name, found, ONE_VEHICLE, advice))
}

/// What a log's vehicle is, in words.
fn kind(quality: &Quality) -> String {
    let VehicleRecord { kind, rotors, .. } = quality.log.vehicle;
    let kind = kind.map_or("vehicle of no known kind".into(), |kind| kind.name().replace('_', " "));
    rotors.map_or(format!("a {kind}"), |rotors| format!("a {kind} with {rotors} rotors"))
}

/// Fails where the logs' records contradict each other about the mass.
pub fn masses(logs: &[Quality]) -> Result<(), BadInput> {
    let mass = |record: &VehicleRecord| record.mass_kg.map(|mass| vec![mass]);
    agree(logs, mass, |mass| format!("a mass of {} kg", mass[0]), "--mass of `racer identify`")
}

/// Fails where the logs' records contradict each other about the rates that a full stick asks for.
pub fn full_rates(logs: &[Quality]) -> Result<(), BadInput> {
    let rates = |record: &VehicleRecord| record.max_rate_rad_s.map(|rates| rates.map(f64::to_degrees).to_vec());
    let words = |rates: &[f64]| {
        let rates: Vec<String> = rates.iter().map(|rate| format!("{rate:.0}")).collect();
        format!("full-stick rates of {} deg/s", rates.join(", "))
    };
    agree(logs, rates, words, "--full-rates of `racer identify`")
}

/// Fails where two records have these numbers and they differ.
fn agree(
    logs: &[Quality],
    of: impl Fn(&VehicleRecord) -> Option<Vec<f64>>,
    words: impl Fn(&[f64]) -> String,
    option: &str,
) -> Result<(), BadInput> {
    let apart = |a: f64, b: f64| (a - b).abs() > SAME_RECORD.get() * a.abs().max(b.abs());
    for (earlier, later) in pairs(logs) {
        let (Some(a), Some(b)) = (of(&earlier.log.vehicle), of(&later.log.vehicle)) else { continue };
        if a.iter().zip(&b).any(|(a, b)| apart(*a, *b)) {
            let found = format!("{}, and {} of {}", words(&b), words(&a), earlier.log.name);
            let advice = format!(
                "leave out the flights of another vehicle. Where it is the same, {option} says what holds, or give \
                 --despite-problems"
            );
            return Err(BadInput::new(&later.log.name, found, ONE_VEHICLE, advice));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::{Log, VehicleKind};
    use crate::insight::quality::check;

    fn log(name: &str, rate: f64) -> Log {
        let mut log = Log { name: name.into(), ..Log::default() };
        (0..100).for_each(|i| log.imu.push(0.01 * f64::from(i), [rate, 0.0, 0.0, f64::NAN, f64::NAN, f64::NAN]));
        log
    }

    fn both(change: impl Fn(&mut VehicleRecord)) -> Vec<Quality> {
        let (first, mut second) = (log("a", 1.0), log("b", 2.0));
        change(&mut second.vehicle);
        [first, second].iter_mut().map(|log| check(log)).collect()
    }

    #[test]
    fn a_flight_is_the_same_also_where_a_sensor_is_missing() {
        assert!(flights(&both(|_| ())).is_ok());
        let error = flights(&[log("a", 1.0), log("copy", 1.0)].map(|log| check(&log))).unwrap_err().to_string();
        assert!(error.contains("copy") && error.contains("the same flight as a"), "{error}");
        assert!(flights(&[Log::default(), Log::default()].map(|log| check(&log))).is_ok());
    }

    #[test]
    fn records_that_contradict_each_other_are_of_two_vehicles() {
        let other = both(|record| (record.kind, record.rotors) = (Some(VehicleKind::Multirotor), Some(6)));
        let error = kinds(&other).unwrap_err().to_string();
        assert!(error.contains("multirotor with 6 rotors") && error.contains("no known kind"), "{error}");
        // What one of them does not say contradicts nothing.
        let heavy = both(|record| (record.mass_kg, record.max_rate_rad_s) = (Some(0.8), Some([10.0, 10.0, 5.0])));
        assert!(masses(&heavy).is_ok() && full_rates(&heavy).is_ok() && kinds(&heavy).is_ok());
        let mut three = heavy;
        let mut third = log("c", 3.0);
        (third.vehicle.mass_kg, third.vehicle.max_rate_rad_s) = (Some(0.805), Some([10.0, 10.0, 6.0]));
        three.push(check(&third));
        assert!(masses(&three).is_ok());
        let error = full_rates(&three).unwrap_err().to_string();
        assert!(error.contains("573, 573, 344 deg/s, and full-stick rates of 573, 573, 286"), "{error}");
        three[2].log.vehicle.mass_kg = Some(0.7);
        assert!(masses(&three).unwrap_err().to_string().contains("a mass of 0.7 kg, and a mass of 0.8 kg of b"));
    }
}
