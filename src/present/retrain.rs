//! What an extended vehicle is worth for racing: policies trained or flown with it and without.

use super::run::Run;
use super::train::{Ended, TrainingWatch, make};
use crate::base::encode;
use crate::base::error::{Error, Result};
use crate::base::fsio::write_new;
use crate::base::lane::Level;
use crate::base::threads;
use crate::model::vehicle::Vehicle;
use crate::race::config::{DEFAULT, Setting, Setup};
use crate::race::env::reset::StartPlace;
use crate::race::eval::benchmark;
use crate::race::eval::score::Benchmark;
use crate::race::snapshot::Snapshot;
use std::path::Path;

/// A vehicle and what it is called in the comparison.
pub type NamedVehicle<'a> = (&'static str, &'a Vehicle);

/// Flies `policy` from the pad in `vehicle`, with the random numbers of its own seed, whatever the vehicle.
pub fn fly(policy: &Snapshot, vehicle: &Vehicle) -> Result<Benchmark> {
    let about = &policy.about;
    let race = policy.race(Some(vehicle));
    threads::on(None, || benchmark(Level::best(), &race, &about.track, &policy.network, StartPlace::Pad, &about.eval).0)
}

/// Trains one policy in each of two vehicles for `minutes`, each in a folder of its name in the new folder `to`, and
/// flies both in the second vehicle. [`Error::Interrupted`] where whoever watches asks to stop: half of a comparison is
/// none.
pub fn retrain(
    to: &Path,
    minutes: f64,
    vehicles: [NamedVehicle; 2],
    threads: usize,
    watch: &mut dyn TrainingWatch,
) -> Result<Vec<(&'static str, Benchmark)>> {
    let (_, flown) = vehicles[1];
    let mut all = Vec::new();
    for (name, vehicle) in vehicles {
        let stopped = || {
            let folder = to.display();
            Error::Interrupted(format!(
                "Stopped while training in the {name} vehicle: without both trainings there is no comparison. What was \
                 trained so far is in {folder}."
            ))
        };
        let file = to.join(format!("{name}.toml"));
        write_new(&file, encode::toml("the vehicle", vehicle)?.as_bytes()).map_err(Error::write(&file))?;
        let settings = [
            Setting::of("--vehicle", "vehicle", file.display().to_string()),
            Setting::of("--minutes", "budget.minutes", minutes),
        ];
        let setup = Setup::load(DEFAULT, &settings)?;
        let run = Run::create(Some(&to.join(name)), &setup.track.name)?;
        let command = format!("racer train --vehicle {} --minutes {minutes}", file.display());
        match make(&run, &setup, threads, &command, watch)? {
            Ended::Finished(finished) if !watch.stop() => all.push((name, fly(&finished.policy, flown)?)),
            _ => return Err(stopped()),
        }
    }
    if watch.stop() {
        return Err(Error::Interrupted("Stopped: the policies that were trained have not all been flown.".into()));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Impatient;

    impl TrainingWatch for Impatient {
        fn stop(&self) -> bool {
            true
        }
    }

    #[test]
    fn half_of_a_comparison_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let vehicle = Vehicle::load("seed_class").unwrap();
        let vehicles = [("base", &vehicle), ("extended", &vehicle)];
        let error = retrain(folder.path(), 10.0, vehicles, 2, &mut Impatient).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, Error::Interrupted(_)), "{text}");
        assert!(text.contains("base") && text.contains("no comparison"), "{text}");
        assert!(folder.path().join("base/metrics.csv").is_file(), "what was trained is kept");
        assert!(!folder.path().join("extended").exists(), "the second training has not begun");
    }
}
